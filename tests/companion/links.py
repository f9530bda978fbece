"""Connections between the simulated autopilot and the companion: UDP, TCP and a serial line, with their faults."""

from __future__ import annotations

import contextlib
import fcntl
import itertools
import os
import pty
import random
import socket
import struct
import termios
import time
import tty
from dataclasses import dataclass, field
from typing import Callable

from loop import HANG_S, Loop

HOST = "127.0.0.1"
Receive = Callable[[bytes], None]


_ports = itertools.count(random.randrange(20000, 30000))


def free_port(kind: int = socket.SOCK_DGRAM) -> int:
    """A port below the range of the system's automatic assignment, which therefore stays free for the companion."""
    while True:
        port = 20000 + next(_ports) % 12000
        with socket.socket(socket.AF_INET, kind) as probe:
            try:
                probe.bind((HOST, port))
            except OSError:
                continue
            return port


@dataclass
class Faults:
    """Faults of a bad link for datagrams: probabilities, and the longest delay."""

    lost: float = 0.0
    doubled: float = 0.0
    delay_s: float = 0.0
    dice: random.Random = field(default_factory=lambda: random.Random(7))

    def copies(self) -> list[float]:
        """The delay of each copy of one datagram; empty if it is lost."""
        if self.dice.random() < self.lost:
            return []
        number = 2 if self.dice.random() < self.doubled else 1
        return [self.dice.uniform(0.0, self.delay_s) for _ in range(number)]


class Wire:
    """One end of a link. `setting` is the companion's configuration of the other end."""

    setting: str
    sent = 0
    dropped = 0  # datagrams sent

    def __init__(self, loop: Loop, receive: Receive, faults: Faults | None = None) -> None:
        self.loop, self.receive, self.faults = loop, receive, faults

    def send(self, data: bytes) -> None:
        self.sent += 1
        self.dropped += self._spread(data, self._put) == 0

    def _got(self, data: bytes) -> None:
        self._spread(data, self.receive)

    def _spread(self, data: bytes, put: Receive) -> int:
        copies = self.faults.copies() if self.faults else [0.0]
        for delay_s in copies:
            if delay_s > 0.0:
                self.loop.after(delay_s, lambda: put(data))
            else:
                put(data)
        return len(copies)

    def _put(self, data: bytes) -> None:
        raise NotImplementedError

    def reopen(self) -> None:
        """Restarts the device behind it."""

    def close(self) -> None:
        raise NotImplementedError


class UdpWire(Wire):
    """Sends from a socket to the companion's port; after reopen() from another socket."""

    def __init__(self, loop: Loop, receive: Receive, faults: Faults | None = None) -> None:
        super().__init__(loop, receive, faults)
        self.port = free_port()
        self.setting = f"udpin:{HOST}:{self.port}"
        self._open()

    def _open(self) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((HOST, 0))
        self.socket.setblocking(False)
        self.loop.watch(self.socket, self._read)

    def _read(self) -> None:
        try:
            data = self.socket.recv(65536)
        except OSError:  # the companion does not listen yet
            return
        self._got(data)

    def _put(self, data: bytes) -> None:
        with contextlib.suppress(OSError):
            self.socket.sendto(data, (HOST, self.port))

    def reopen(self) -> None:
        self.close()
        self._open()

    def close(self) -> None:
        self.loop.forget(self.socket)
        self.socket.close()


class UdpServerWire(Wire):
    """Waits on a port and answers to the latest sender. It opens late, which the companion has to tolerate."""

    def __init__(self, loop: Loop, receive: Receive, faults: Faults | None = None, late_s: float = 1.5) -> None:
        super().__init__(loop, receive, faults)
        self.port = free_port()
        self.setting = f"udpout:{HOST}:{self.port}"
        self.socket: socket.socket | None = None
        self.peer: tuple[str, int] | None = None
        loop.after(late_s, self._open)

    def _open(self) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((HOST, self.port))
        self.socket.setblocking(False)
        self.loop.watch(self.socket, self._read)

    def _read(self) -> None:
        assert self.socket
        try:
            data, self.peer = self.socket.recvfrom(65536)
        except OSError:
            return
        self._got(data)

    def _put(self, data: bytes) -> None:
        if self.socket and self.peer:
            self.socket.sendto(data, self.peer)

    def close(self) -> None:
        if self.socket:
            self.loop.forget(self.socket)
            self.socket.close()


class TcpWire(Wire):
    """Listens like a simulated autopilot; after reopen() the companion has to connect again."""

    def __init__(self, loop: Loop, receive: Receive, faults: Faults | None = None) -> None:
        super().__init__(loop, receive, faults)
        self.listener = socket.create_server((HOST, 0))
        self.setting = f"tcp:{HOST}:{self.listener.getsockname()[1]}"
        self.peer: socket.socket | None = None
        self.calls = 0
        loop.watch(self.listener, self._accept)

    def _accept(self) -> None:
        self.reopen()
        self.peer = self.listener.accept()[0]
        self.peer.setblocking(False)
        self.peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # an acknowledgement would come in real time
        self.calls += 1
        self.loop.watch(self.peer, self._read)

    def _read(self) -> None:
        assert self.peer
        try:
            data = self.peer.recv(65536)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if data:
            self._got(data)
        else:
            self.reopen()

    def _put(self, data: bytes) -> None:
        if self.peer:
            try:
                self.peer.sendall(data)
            except OSError:
                self.reopen()

    def reopen(self) -> None:
        if self.peer:
            self.loop.forget(self.peer)
            self.peer.close()
            self.peer = None

    def close(self) -> None:
        self.reopen()
        self.loop.forget(self.listener)
        self.listener.close()


def unread(terminal: int) -> int:
    """Number of bytes that wait in the input."""
    return struct.unpack("i", fcntl.ioctl(terminal, termios.FIONREAD, bytes(4)))[0]


def wait_for_bytes(terminal: int, number: int) -> None:
    """The system delivers data written to a terminal only after the write has ended. At most 4 KiB arrive before some
    are read."""
    end_s = time.monotonic() + HANG_S
    while unread(terminal) < min(number, 4000):
        if time.monotonic() > end_s:
            raise TimeoutError(f"{unread(terminal)} of {number} bytes")
        time.sleep(1e-4)


class SerialWire(Wire):
    """The master side of a pseudo terminal."""

    def __init__(self, loop: Loop, receive: Receive, faults: Faults | None = None) -> None:
        super().__init__(loop, receive, faults)
        self.master, self.slave = pty.openpty()  # the slave is kept open, as by a cable: no hang-up
        tty.setraw(self.master)
        os.set_blocking(self.master, False)
        self.setting = f"serial:{os.ttyname(self.slave)}:115200"
        self.got = 0  # bytes
        loop.watch(self.master, self._read)

    def _read(self) -> None:
        with contextlib.suppress(OSError):
            data = os.read(self.master, 65536)
            self.got += len(data)
            self._got(data)

    def _put(self, data: bytes) -> None:
        before = unread(self.slave)
        with contextlib.suppress(BlockingIOError):
            wait_for_bytes(self.slave, before + os.write(self.master, data))

    def wait_for_written(self, written: int) -> None:
        """Waits until all bytes that the companion has written so far have arrived."""
        wait_for_bytes(self.master, written - self.got)

    def close(self) -> None:
        self.loop.forget(self.master)
        os.close(self.master)
        os.close(self.slave)


WIRES: dict[str, type[Wire]] = {"udpin": UdpWire, "udpout": UdpServerWire, "tcp": TcpWire, "serial": SerialWire}
