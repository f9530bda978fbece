"""Wires between the simulated autopilot and the companion: UDP, TCP and a serial line, and what goes wrong on them."""

from __future__ import annotations

import contextlib
import itertools
import os
import pty
import random
import socket
import time
import tty
from dataclasses import dataclass, field
from typing import Callable

from loop import Loop

HOST = "127.0.0.1"
Receive = Callable[[bytes], None]


_ports = itertools.count(random.randrange(20000, 30000))


def free_port(kind: int = socket.SOCK_DGRAM) -> int:
    """Below those that the system hands out by itself: nobody takes it until the companion does."""
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
    """What a bad link does to datagrams: shares of all, and the longest delay of each."""

    lost: float = 0.0
    doubled: float = 0.0
    delay_s: float = 0.0
    dice: random.Random = field(default_factory=lambda: random.Random(7))

    def copies(self) -> list[float]:
        """The delay of each copy of one datagram; empty: it is lost."""
        if self.dice.random() < self.lost:
            return []
        number = 2 if self.dice.random() < self.doubled else 1
        return [self.dice.uniform(0.0, self.delay_s) for _ in range(number)]


class Wire:
    """One end of a link. `setting` is what the companion's configuration calls the other end."""

    setting: str
    sent = 0
    dropped = 0  # of those sent

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
                self.loop.at(time.monotonic() + delay_s, lambda: put(data))
            else:
                put(data)
        return len(copies)

    def _put(self, data: bytes) -> None:
        raise NotImplementedError

    def reopen(self) -> None:
        """The device behind it restarts."""

    def close(self) -> None:
        raise NotImplementedError


class UdpWire(Wire):
    """A socket of its own that sends to the companion's port; after reopen() another one."""

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
        except OSError:  # nobody listens there yet
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
    """Waits on a port and answers where it was last heard from. It opens late: the companion has to bear that."""

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
    """Listens, as a simulated autopilot does; after reopen() the companion has to call again."""

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


class SerialWire(Wire):
    """The master's side of a pseudo terminal."""

    def __init__(self, loop: Loop, receive: Receive, faults: Faults | None = None) -> None:
        super().__init__(loop, receive, faults)
        self.master, self.slave = pty.openpty()  # the slave is held open, as a cable is: no hang-up
        tty.setraw(self.master)
        os.set_blocking(self.master, False)
        self.setting = f"serial:{os.ttyname(self.slave)}:115200"
        loop.watch(self.master, self._read)

    def _read(self) -> None:
        with contextlib.suppress(OSError):
            self._got(os.read(self.master, 65536))

    def _put(self, data: bytes) -> None:
        with contextlib.suppress(BlockingIOError):
            os.write(self.master, data)

    def close(self) -> None:
        self.loop.forget(self.master)
        os.close(self.master)
        os.close(self.slave)


WIRES: dict[str, type[Wire]] = {"udpin": UdpWire, "udpout": UdpServerWire, "tcp": TcpWire, "serial": SerialWire}
