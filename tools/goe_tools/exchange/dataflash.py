"""Reads ArduPilot's log with pymavlink.

XKF1, XKQ, XKF4 of EKF3, otherwise NKF1, NKQ, NKF4 of EKF2: position, velocity and attitude of each core, the primary
core, and the latest horizontal jump. IMU: rates. RFND, otherwise TERR: height above the ground. EV: reported yaw
resets. Other jumps are detected from the velocity and the rates."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..logs.fields import LogError
from .recording import Jump, Recording, Series, made_upright, make_attitude, make_series
from .resets import attitude_jumps, merged, position_jumps, unexplained_m, unreported

FILTERS = ("XK", "NK")
EVENT_YAW_RESET = 62
DOWNWARD, RANGE_GOOD = 25, 4  # RFND: orientation and status
US = 1e-6
JUMP_LEAST_M = 0.01  # of a reported horizontal jump; a smaller change is the same number again
JUMP_SEARCH_S = 1.0  # before the message that reports it
JUMP_AGREES_M, JUMP_AGREES_SHARE = 0.5, 0.3

Table = dict[str, np.ndarray]  # columns of a message


def _messages(path: Path, names: list[str]) -> dict[str, Table]:
    """Columns of the messages with these names, if present."""
    from pymavlink import DFReader  # imported here: the other formats do not need it

    try:
        with path.open("rb") as file:
            if file.read(2) != b"\xa3\x95":
                raise LogError(path, 0, "", "not a DataFlash file: it does not start with a message header")
        reader = DFReader.DFReader_binary(str(path), zero_time_base=True)
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None
    except LogError:
        raise
    except Exception as error:  # a damaged file makes the reader raise any kind
        raise LogError(path, 0, "", f"not a DataFlash file: {error}") from None
    rows: dict[str, list[list[object]]] = {}
    columns: dict[str, list[str]] = {}
    while True:
        try:
            message = reader.recv_match(type=names)
        except Exception as error:
            raise LogError(path, 0, "", f"damaged: {error}") from None
        if message is None:
            break
        name = message.get_type()
        columns.setdefault(name, list(message.get_fieldnames()))
        rows.setdefault(name, []).append([getattr(message, column) for column in columns[name]])
    return {
        name: dict(zip(columns[name], (np.array(column) for column in zip(*values)))) for name, values in rows.items()
    }


def _columns(path: Path, name: str, table: Table, *fields: str) -> np.ndarray:
    """Columns as an array, (N, n)."""
    for field in fields:
        if field not in table:
            raise LogError(path, 0, f"{name}.{field}", "the message has no such field")
    return np.column_stack([np.asarray(table[field], float) for field in fields])


def _only(table: Table, rows: np.ndarray) -> Table:
    return {name: column[rows] for name, column in table.items()}


def _time_s(path: Path, name: str, table: Table) -> np.ndarray:
    return _columns(path, name, table, "TimeUS")[:, 0] * US


def _primary(path: Path, name: str, status: Table | None, time_s: np.ndarray) -> tuple[np.ndarray, list[Jump]]:
    """(K,) number of the primary core at each time, and its changes."""
    if status is None or "PI" not in status:
        return np.zeros(len(time_s), int), []
    when, which = _time_s(path, name, status), np.asarray(status["PI"], int)
    changes = [
        Jump(float(when[k]), None, f"{name}.PI: core {which[k]} takes over")
        for k in np.flatnonzero(np.diff(which, prepend=which[0]))
    ]
    at = np.clip(np.searchsorted(when, time_s, side="right") - 1, 0, len(which) - 1)
    return which[at], changes


def _of_core(path: Path, name: str, table: Table, core: np.ndarray) -> Table:
    """The rows of the primary core."""
    if "C" not in table:
        return table
    rows = np.asarray(table["C"], int) == core
    if not rows.any():
        raise LogError(path, 0, f"{name}.C", f"no row belongs to the primary core, {sorted(set(core.tolist()))}")
    return _only(table, rows)


def _reported_jumps(path: Path, name: str, status: Table | None, position: Series, velocity: Series) -> list[Jump]:
    """Jumps in the fields OFN and OFE, which contain the latest horizontal jump. Its time is that of a matching step of
    the positions before the message; without such a step, its size is unknown."""
    if status is None or "OFN" not in status or "OFE" not in status:
        return []
    when, reported = _time_s(path, name, status), _columns(path, name, status, "OFN", "OFE")
    off, result = unexplained_m(position, velocity), []
    changed = np.concatenate([[False], np.linalg.norm(np.diff(reported, axis=0), axis=1) > JUMP_LEAST_M])
    for k in np.flatnonzero(changed):
        near = np.flatnonzero((position.time_s[1:] > when[k] - JUMP_SEARCH_S) & (position.time_s[1:] <= when[k] + 1e-9))
        miss = np.linalg.norm(off[near, :2] - reported[k], axis=1)
        best = int(np.argmin(miss)) if len(near) else 0
        if len(near) and miss[best] <= JUMP_AGREES_M + JUMP_AGREES_SHARE * np.linalg.norm(reported[k]):
            at = float(position.time_s[1:][near[best]])
            down = float(off[near[best], 2])
            delta = (*(float(x) for x in reported[k]), down if abs(down) > JUMP_AGREES_M else 0.0)
            result.append(Jump(at, delta, f"{name}.OFN, OFE"))  # type: ignore[arg-type]
        else:
            result.append(Jump(float(when[k]), None, f"{name}.OFN, OFE: no such step in the positions"))
    return result


def _events(path: Path, table: Table | None) -> list[Jump]:
    if table is None or "Id" not in table:
        return []
    when = _time_s(path, "EV", table)
    return [Jump(float(when[k]), None, "EV.Id: yaw reset") for k in np.flatnonzero(table["Id"] == EVENT_YAW_RESET)]


def _gyro(path: Path, table: Table | None) -> Series | None:
    """The rates of the first IMU."""
    if table is None:
        return None
    if "I" in table:
        table = _only(table, np.asarray(table["I"], int) == int(np.min(table["I"])))
    rates = _columns(path, "IMU", table, "GyrX", "GyrY", "GyrZ")
    return make_series(path, "IMU.GyrX, GyrY, GyrZ", _time_s(path, "IMU", table), rates)


def _clearance(path: Path, messages: dict[str, Table], attitude: Series) -> Series | None:
    finder = messages.get("RFND")
    if finder is not None:
        good = np.ones(len(finder["TimeUS"]), bool)
        for field, wanted in (("Orient", DOWNWARD), ("Stat", RANGE_GOOD)):
            good &= np.asarray(finder[field], int) == wanted if field in finder else True
        if good.sum() >= 2:
            finder = _only(finder, good)
            distance = _columns(path, "RFND", finder, "Dist")
            return made_upright(make_series(path, "RFND.Dist", _time_s(path, "RFND", finder), distance), attitude)
    terrain = messages.get("TERR")
    if terrain is not None and len(terrain["TimeUS"]) >= 2:
        height = _columns(path, "TERR", terrain, "CHeight")
        return make_series(path, "TERR.CHeight", _time_s(path, "TERR", terrain), height)
    return None


def read_dataflash(path: Path) -> Recording:
    wanted = [f"{kind}{part}" for kind in FILTERS for part in ("F1", "Q", "F4")]
    messages = _messages(path, [*wanted, "IMU", "RFND", "TERR", "EV"])
    kind = next((kind for kind in FILTERS if f"{kind}F1" in messages), None)
    if kind is None:
        raise LogError(path, 0, "XKF1", "the log has no such message, and no NKF1: the position was not logged")
    name_1, name_q, name_4 = (f"{kind}{part}" for part in ("F1", "Q", "F4"))
    if name_q not in messages:
        raise LogError(path, 0, name_q, "the log has no such message: the attitude was not logged")
    status = messages.get(name_4)
    if status is not None and "C" in status:
        status = _only(status, np.asarray(status["C"], int) == int(np.min(status["C"])))
    core, changes = _primary(path, name_4, status, _time_s(path, name_1, messages[name_1]))
    place = _of_core(path, name_1, messages[name_1], core)
    core, _ = _primary(path, name_4, status, _time_s(path, name_q, messages[name_q]))
    turn = _of_core(path, name_q, messages[name_q], core)
    time_s = _time_s(path, name_1, place)
    ned = _columns(path, name_1, place, "PN", "PE", "PD")
    speed = _columns(path, name_1, place, "VN", "VE", "VD")
    position = make_series(path, f"{name_1}.PN, PE, PD", time_s, ned)
    velocity = make_series(path, f"{name_1}.VN, VE, VD", time_s, speed)
    q = _columns(path, name_q, turn, "Q1", "Q2", "Q3", "Q4")
    attitude = make_attitude(path, f"{name_q}.Q1 to Q4", _time_s(path, name_q, turn), q)
    gyro = _gyro(path, messages.get("IMU"))
    reported = _reported_jumps(path, name_4, status, position, velocity) + changes + _events(path, messages.get("EV"))
    found = unreported(position_jumps(position, velocity, f"{name_1}: a step"), reported, JUMP_SEARCH_S)
    turned = attitude_jumps(attitude, gyro, f"{name_q}: a turn by") if gyro is not None else []
    found += unreported(turned, [jump for jump in reported if jump.delta_m is None], JUMP_SEARCH_S)
    return Recording(
        path, position, attitude, gyro, velocity, _clearance(path, messages, attitude), merged(reported + found)
    )
