"""A simulated autopilot: an aircraft, its own clock, and the part of MAVLink that the companion uses."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any, Callable

from links import Faults, UdpWire, Wire
from loop import Loop

LAT_E7, LON_E7, ALT_M = 473977420, 85455940, 488.0  # of the local frame's origin
METERS_PER_DEGREE = 111319.49
ARDUPILOT, PX4 = 3, 12
MODES = {ARDUPILOT: 10, PX4: 4 << 16 | 4 << 24}  # AUTO; AUTO.MISSION
LOITER = 4 << 16 | 3 << 24  # PX4: AUTO.LOITER
DO_SET_MODE, DO_GO_AROUND, DO_REPOSITION, SET_MESSAGE_INTERVAL, REQUEST_MESSAGE = 176, 191, 192, 511, 512
BANK, BANK_RATE = math.radians(30.0), math.radians(60.0)  # in a turn, and while rolling into it
CLIMB_M_S = 3.0  # in a go-around
ASKING = (SET_MESSAGE_INTERVAL, REQUEST_MESSAGE)  # commands that request messages and move nothing
SIGNING_EPOCH_S = 1_420_070_400  # UNIX time of 2015, the epoch of signature times, in units of 10 us
ACCEPTED, REJECTED, DENIED, FAILED = 0, 1, 2, 4  # results of a command
ATTITUDE, POSITION, ODOMETRY = 31, 32, 331  # messages: ATTITUDE_QUATERNION, LOCAL_POSITION_NED


def numbered(message: Any, mavlink: Any) -> bytes:
    """A frame with a fixed sequence number of the sender."""
    frame: bytes = message.pack(mavlink)
    mavlink.seq = (mavlink.seq + 1) % 256
    return frame


def local_m(lat_e7: int, lon_e7: int) -> tuple[float, float]:
    """North and east of the origin in m; valid for some kilometers around it."""
    north = (lat_e7 - LAT_E7) * 1e-7 * METERS_PER_DEGREE
    east = (lon_e7 - LON_E7) * 1e-7 * METERS_PER_DEGREE * math.cos(math.radians(LAT_E7 * 1e-7))
    return north, east


def quaternion(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """Body to NED, (w, x, y, z), of angles in radians."""
    cr, sr, cp, sp = math.cos(roll / 2), math.sin(roll / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


@dataclass(frozen=True)
class Pose:
    """The pose at one moment: NED, m, m/s, rad, rad/s."""

    position: tuple[float, float, float]
    velocity: tuple[float, float, float]
    angles: tuple[float, float, float]
    rates: tuple[float, float, float]

    @property
    def q(self) -> tuple[float, float, float, float]:
        return quaternion(*self.angles)


@dataclass
class Aircraft:
    """Flies north, or turns towards `goal` as a bank of 30 degrees allows; climbs to `climb_to_m`."""

    north_m: float = 0.0
    east_m: float = 0.0
    height_m: float = 30.0
    speed_m_s: float = 20.0
    course: float = 0.0
    roll_deg: float = 3.0
    roll_hz: float = 0.4
    goal: tuple[float, float] | None = None
    climb_to_m: float = -math.inf
    time_s: float = 0.0
    begin_s: float = field(init=False)
    bank: float = field(init=False, default=0.0)
    bank_rate: float = field(init=False, default=0.0)

    def __post_init__(self) -> None:
        self.begin_s = self.time_s

    def _wanted_bank(self) -> float:
        wanted = math.atan2(self.goal[1] - self.east_m, self.goal[0] - self.north_m) if self.goal else 0.0
        error = math.remainder(wanted - self.course, 2 * math.pi)
        return max(-BANK, min(BANK, 2.0 * error))

    def advance(self, now_s: float) -> Pose:
        while self.time_s < now_s:
            self._step(min(0.02, now_s - self.time_s))
            self.time_s = min(self.time_s + 0.02, now_s)
        return self.pose()

    def _step(self, step_s: float) -> None:
        error = self._wanted_bank() - self.bank
        self.bank_rate = max(-BANK_RATE, min(BANK_RATE, 4.0 * error))
        middle = self.course + 0.5 * self.turn * step_s
        self.bank += self.bank_rate * step_s
        self.course += self.turn * step_s
        self.north_m += self.speed_m_s * step_s * math.cos(middle)
        self.east_m += self.speed_m_s * step_s * math.sin(middle)
        self.height_m += self.climb_m_s * step_s

    @property
    def climb_m_s(self) -> float:
        return CLIMB_M_S if self.height_m < self.climb_to_m else 0.0

    @property
    def turn(self) -> float:
        """Rate of the course, rad/s."""
        return 9.81 * math.tan(self.bank) / self.speed_m_s

    def place(self) -> tuple[float, float]:
        return self.north_m, self.east_m

    def pose(self) -> Pose:
        omega = 2 * math.pi * self.roll_hz
        phase, most = omega * (self.time_s - self.begin_s), math.radians(self.roll_deg)
        roll, rate = self.bank + most * math.sin(phase), self.bank_rate + most * omega * math.cos(phase)
        return Pose(
            (self.north_m, self.east_m, -self.height_m),
            (self.speed_m_s * math.cos(self.course), self.speed_m_s * math.sin(self.course), -self.climb_m_s),
            (roll, 0.0, self.course),
            (rate, self.turn * math.sin(roll), self.turn * math.cos(roll)),
        )


class Clock:
    """Time since boot, in seconds of the loop's time."""

    def __init__(self, loop: Loop, boot_s: float, drift: float = 0.0) -> None:
        self.loop, self.begin_s, self.boot_s, self.drift = loop, loop.now_s, boot_s, drift

    def at(self, time_s: float) -> float:
        return self.boot_s + (time_s - self.begin_s) * (1.0 + self.drift)

    def jump(self, by_s: float) -> None:
        self.boot_s += by_s

    def restart(self) -> None:
        self.begin_s, self.boot_s = self.loop.now_s, 0.0


@dataclass(frozen=True)
class Heard:
    """A message of the companion, and the aircraft's position when it arrived."""

    time_s: float
    message: Any
    place: tuple[float, float]

    @property
    def north_m(self) -> float:
        return self.place[0]


class Autopilot:
    """Sends and answers over a wire; `heard` lists all received messages.

    `ignored` is the number of times that a command is neither obeyed nor answered, so that the companion has to repeat
    it. With `most_hz` the autopilot sends poses only on request, up to this rate, and refuses higher rates with
    `refusal`. It lacks the messages in `refused`. With a `key` it signs its messages and refuses messages without a
    valid signature; its clock for signatures may be late by `late_s`.
    """

    def __init__(
        self,
        loop: Loop,
        dialect: ModuleType,
        *,
        wire: type[Wire] = UdpWire,
        faults: Faults | None = None,
        make: int = PX4,
        aircraft: Aircraft | None = None,
        boot_s: float = 1000.0,
        drift: float = 0.0,
        pose_hz: float = 50.0,
        ignored: dict[int, int] | None = None,
        landing: bool = False,
        most_hz: float | None = None,
        refused: Sequence[int] = (),
        refusal: int = FAILED,
        key: bytes | None = None,
        late_s: float = 0.0,
    ) -> None:
        self.loop, self.dialect, self.make = loop, dialect, make
        self.aircraft = aircraft or Aircraft(time_s=loop.now_s)
        self.clock = Clock(loop, boot_s, drift)
        self.wire = wire(loop, self._receive, faults)
        self.heard: list[Heard] = []
        self.answers = Counter[int]()  # answers to own TIMESYNC questions, by the time in the question
        self.mode, self.modes = MODES[make], [MODES[make]]
        self.ignored, self.landing = Counter(ignored or {}), landing
        self.silent = False  # neither sends nor receives
        self.posing = True
        self.positioning = True  # False: of the pose the attitude alone is sent
        self.shift = (0.0, 0.0, 0.0)  # of the local frame: a reset of the filter
        self.yaw_shift = 0.0
        self.reset_counter: int | None = None  # a number: ODOMETRY is sent, too
        self.questions: list[int] = []
        self.most_hz, self.refused, self.refusal = most_hz, refused, refusal
        self.key, self.refused_signatures, self.late_s = key, 0, late_s
        self.gps_fix: int | None = None  # a number: GPS_RAW_INT is sent with this fix
        self.filter_flags: int | None = None  # a number: the filter state is sent in the form of the autopilot's make
        self._fresh()
        loop.every(1.0 / pose_hz, self._pose)
        loop.every(1.0, self._second)

    def _fresh(self) -> None:
        self.intervals: dict[int, float] = {}  # intervals of requested messages, s
        self.due: dict[int, float] = {}
        self.mavlink = self.dialect.MAVLink(None, srcSystem=1, srcComponent=1)
        self.parser = self.dialect.MAVLink(None)
        self.parser.robust_parsing = True
        if self.key:
            signing = self.parser.signing = self.mavlink.signing
            signing.secret_key, signing.sign_outgoing = self.key, True
            signing.timestamp = int((self.loop.unix_s - self.late_s - SIGNING_EPOCH_S) * 1e5)

    # ------------------------------------------------------------------------------------------------------ sending

    def send(self, message: Any, mavlink: Any = None) -> None:
        self.wire.send(numbered(message, mavlink or self.mavlink))

    def boot_s(self) -> float:
        return self.clock.at(self.loop.now_s)

    def _pose(self) -> None:
        now = self.loop.now_s
        pose = self.aircraft.advance(now)
        if self.silent or not self.posing:
            return
        ms = int(self.clock.at(now) * 1e3)
        position = [value + shift for value, shift in zip(pose.position, self.shift)]
        q = quaternion(pose.angles[0], pose.angles[1], pose.angles[2] + self.yaw_shift)
        if self._is_due(ATTITUDE):
            self.send(self.dialect.MAVLink_attitude_quaternion_message(ms, *q, *pose.rates))
        if self.positioning and self._is_due(POSITION):
            self.send(self.dialect.MAVLink_local_position_ned_message(ms, *position, *pose.velocity))
        if self.reset_counter is not None:
            self._odometry(ms * 1000, position, q, pose)

    def _is_due(self, message: int) -> bool:
        if self.most_hz is None:
            return True
        now, interval = self.loop.now_s + 1e-6, self.intervals.get(message)
        if interval is None or now < self.due.get(message, 0.0):
            return False
        self.due[message] = max(self.due.get(message, now) + interval, now)
        return True

    def _odometry(self, us: int, position: list[float], q: tuple[float, ...], pose: Pose) -> None:
        """Velocity in the body frame; level and facing north, body and local frame are equal."""
        unknown = [math.nan] + 20 * [0.0]
        self.send(
            self.dialect.MAVLink_odometry_message(
                us, 1, 12, *position, list(q), *pose.velocity, *pose.rates, unknown, unknown, self.reset_counter
            )
        )

    def _second(self) -> None:
        if self.silent:
            return
        send, us = self.send, int(self.boot_s() * 1e6)
        send(self.dialect.MAVLink_heartbeat_message(1, self.make, 0xD1, self.mode, 4, 3))
        send(self.dialect.MAVLink_gps_global_origin_message(LAT_E7, LON_E7, int(ALT_M * 1e3), us))
        home = [value + shift for value, shift in zip((0.0, 0.0, 0.0), self.shift)]
        send(
            self.dialect.MAVLink_home_position_message(
                LAT_E7, LON_E7, int(ALT_M * 1e3), *home, [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0, us
            )
        )
        self._send_health(us)
        if self.landing:
            send(self.dialect.MAVLink_extended_sys_state_message(0, 4))
        self.questions.append(us * 1000)
        send(self.dialect.MAVLink_timesync_message(0, us * 1000))

    def _send_health(self, us: int) -> None:
        if self.gps_fix is not None:
            self.send(
                self.dialect.MAVLink_gps_raw_int_message(us, self.gps_fix, LAT_E7, LON_E7, 0, 100, 100, 2000, 0, 12)
            )
        if self.filter_flags is not None and self.make == ARDUPILOT:
            self.send(self.dialect.MAVLink_ekf_status_report_message(self.filter_flags, 0.1, 0.1, 0.1, 0.1, 0.0))
        elif self.filter_flags is not None:
            self.send(self.dialect.MAVLink_estimator_status_message(us, self.filter_flags, *6 * [0.1], 1.0, 1.0))

    # ---------------------------------------------------------------------------------------------------- receiving

    def _receive(self, data: bytes) -> None:
        if self.silent:
            return
        for message in self.parser.parse_buffer(data) or []:
            if message.get_type() == "BAD_DATA":
                self.refused_signatures += 1
                continue
            self.heard.append(Heard(self.loop.now_s, message, self.aircraft.place()))
            handle: Callable[[Any], None] | None = getattr(self, f"_on_{message.get_type().lower()}", None)
            if handle:
                handle(message)

    def _on_timesync(self, message: Any) -> None:
        if message.tc1 == 0:
            self.send(self.dialect.MAVLink_timesync_message(int(self.boot_s() * 1e9), message.ts1))
        else:
            self.answers[message.ts1] += 1

    def _on_command_long(self, message: Any) -> None:
        self._command(message, (0, 0))

    def _on_command_int(self, message: Any) -> None:
        self._command(message, (message.x, message.y))

    def _command(self, message: Any, where_e7: tuple[int, int]) -> None:
        if self.ignored[message.command] > 0:
            self.ignored[message.command] -= 1
            return
        if message.command not in ASKING:
            self._obey(message, where_e7)
        result = self._set_interval(message) if message.command == SET_MESSAGE_INTERVAL else ACCEPTED
        self.send(self.dialect.MAVLink_command_ack_message(message.command, result))

    def _set_interval(self, message: Any) -> int:
        number, interval = int(message.param1), message.param2 * 1e-6
        if number in self.refused:
            return DENIED
        if self.most_hz is not None and interval * self.most_hz < 0.999:
            return self.refusal
        self.intervals[number] = interval
        return ACCEPTED

    def _obey(self, message: Any, where_e7: tuple[int, int]) -> None:
        if message.command == DO_REPOSITION:
            self.aircraft.goal = local_m(*where_e7)
            if int(message.param2) & 1:
                self.set_mode(LOITER)
        elif message.command == DO_GO_AROUND:
            self.aircraft.climb_to_m = message.param1
        elif message.command == DO_SET_MODE:
            self.set_mode(int(message.param2) << 16 | int(message.param3) << 24)

    def _on_set_mode(self, message: Any) -> None:
        self.set_mode(message.custom_mode)

    def set_mode(self, mode: int) -> None:
        if mode != LOITER:
            self.aircraft.goal = None
        if mode != self.mode:
            self.mode = mode
            self.modes.append(mode)

    # --------------------------------------------------------------------------------------------- received messages

    def of(self, name: str) -> list[Any]:
        return [heard.message for heard in self.heard if heard.message.get_type() == name]

    def heard_of(self, name: str) -> list[Heard]:
        return [heard for heard in self.heard if heard.message.get_type() == name]

    def commands(self) -> list[Any]:
        """All received commands that would move the aircraft or change its mode."""
        moving = ("SET_MODE", "SET_POSITION_TARGET_LOCAL_NED", "SET_POSITION_TARGET_GLOBAL_INT", "MISSION_ITEM_INT")
        messages = [
            message for message in self.of("COMMAND_LONG") + self.of("COMMAND_INT") if message.command not in ASKING
        ]
        return messages + [message for name in moving for message in self.of(name)]

    # --------------------------------------------------------------------------------------------------- misfortunes

    def restart(self, silent_s: float) -> None:
        """Switches off and later on again: another socket, boot time 0, sequence 0."""
        self.silent = True

        def back() -> None:
            self.wire.reopen()
            self._fresh()
            self.clock.restart()
            self.silent = False

        self.loop.after(silent_s, back)

    def close(self) -> None:
        self.wire.close()
