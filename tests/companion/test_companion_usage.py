"""goe_companion from a user's view: options, configurations, refused input, ends."""

from __future__ import annotations

import os
import pty
import re
import select
import shutil
import signal
import socket
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from camera import Camera
from companion import PROGRAM, ROOT, Companion, Settings, call, ini, is_missing
from links import HOST, free_port
from loop import HANG_S, Loop

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

EXAMPLE = ROOT / "port" / "companion" / "companion.ini"
Make = Callable[[Settings], Companion]
WAIT_S = 0.01  # the companion waits for input that long


def usual() -> dict[str, dict[str, object]]:
    return {
        "link": {"autopilot": f"udpin:{HOST}:{free_port()}"},
        "detections": {"from": f"udp:{HOST}:{free_port()}"},
    }


@pytest.fixture(name="folder")
def configured_folder(tmp_path: Path) -> Path:
    (tmp_path / "camera.ini").write_text(Camera().ini(), encoding="utf-8")
    return tmp_path


@pytest.fixture(name="make")
def companions(tmp_path: Path) -> Iterator[Make]:
    """Makes processes that end with the test in any case."""
    made: list[Companion] = []
    loop = Loop()

    def one(settings: Settings) -> Companion:
        made.append(Companion(loop, tmp_path / f"{len(made)}", settings, Camera().ini()))
        return made[-1]

    yield one
    for companion in made:
        if companion.process:
            companion.stop(signal.SIGKILL)


def check(folder: Path, text: str) -> tuple[int, str, str]:
    path = folder / "companion.ini"
    path.write_text(text, encoding="utf-8")
    done = call("--check", path)
    return done.returncode, done.stdout, done.stderr


# ------------------------------------------------------------------------------------------------------------- options


def test_help() -> None:
    done = call("--help")
    assert done.returncode == 0 and done.stderr == ""
    assert "Usage" in done.stdout and "--check" in done.stdout and "--version" in done.stdout


def test_version() -> None:
    header = (ROOT / "lib" / "goe.h").read_text(encoding="utf-8")
    numbers = [re.search(rf"GOE_VERSION_{part} (\d+)", header) for part in ("MAJOR", "MINOR", "PATCH")]
    done = call("--version")
    assert done.returncode == 0
    assert ".".join(number[1] for number in numbers if number) in done.stdout


@pytest.mark.parametrize("arguments", [(), ("--nonsense",), ("a.ini", "b.ini"), ("--check",), ("--check=3", "a.ini")])
def test_wrong_calls(arguments: tuple[str, ...]) -> None:
    done = call(*arguments)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("goe_companion: ") and done.stderr.count("\n") == 1


def test_a_mistyped_option_is_guessed() -> None:
    done = call("--chekc", "a.ini")
    assert done.returncode == 2
    assert done.stderr.startswith("goe_companion: --chekc: unknown option; did you mean --check?")


def test_output_that_cannot_be_printed_is_reported(folder: Path) -> None:
    (folder / "companion.ini").write_text("", encoding="utf-8")
    for words in (["--help"], ["--version"], ["--check", str(folder / "companion.ini")]):
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, *words], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        assert done.returncode == 2
        assert done.stderr == "goe_companion: standard output: cannot be written: No space left on device\n"


@pytest.mark.parametrize("closed", ["2>&-", "<&- >&- 2>&-"])
def test_no_text_goes_to_the_autopilot_where_streams_are_closed(folder: Path, closed: str) -> None:
    """The number of a closed stream would be that of the next socket. The text is about the key."""
    (folder / "link.key").write_text("5A" * 32)
    (folder / "link.key").chmod(0o644)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as autopilot:
        autopilot.bind((HOST, 0))
        autopilot.settimeout(HANG_S)
        where = f"udpout:{HOST}:{autopilot.getsockname()[1]}"
        settings = {"link": {"autopilot": where, "key_file": "link.key"}, "detections": {"from": "none"}}
        (folder / "companion.ini").write_text(ini(settings))
        words = ["sh", "-c", f'exec "$0" "$1" {closed}', PROGRAM, str(folder / "companion.ini")]
        with subprocess.Popen(words) as process:
            try:
                heard = autopilot.recv(2048)
            finally:
                process.kill()
    assert heard[0] == 0xFD, heard


# ------------------------------------------------------------------------------------------------------ configurations


def test_the_example_is_accepted(folder: Path) -> None:
    """With a camera.ini in the same folder; the result are the defaults."""
    shutil.copy(EXAMPLE, folder)
    done = call("--check", folder / "companion.ini")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == check(folder, "")[1]


def test_the_example_has_every_key_with_its_default(folder: Path) -> None:
    """The output of --check and the file agree, apart from the format of numbers."""
    lines = check(folder, "")[1].splitlines()
    printed = {key.strip(): value.strip() for key, value in (line.split("=", 1) for line in lines if "=" in line)}
    section, missing = "", []
    for line in EXAMPLE.read_text(encoding="utf-8").splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("["):
            section = line.strip("[]")
        elif line:
            key, value = (part.strip() for part in line.split("=", 1))
            printed_value = printed.pop(f"{section}.{key}", None)
            if printed_value is None or (
                value != printed_value and not same_number(value, printed_value) and key != "file"
            ):
                missing.append(f"{section}.{key}: {value} and {printed_value}")
    assert missing == []
    # [estimator] and [flight] are documented elsewhere, and the camera in its own file.
    rest = [key for key in printed if key.split(".")[0] in ("link", "detections", "reaction", "reports", "record")]
    assert rest == []


def same_number(one: str, other: str) -> bool:
    try:
        return float(int(one, 0) if one.startswith("0x") else float(one)) == float(
            int(other, 0) if other.startswith("0x") else float(other)
        )
    except ValueError:
        return False


def test_settings_are_printed(folder: Path) -> None:
    text = """# blank lines, comments, blanks
[link]
  autopilot = udpout:127.0.0.1:14550   # a comment
component=191

[flight]
margin_m = 22.5
[estimator]
navigation.attitude_bias_sd_deg = 1.25
[reports]
standard = collision obstacle_distance
"""
    status, out, err = check(folder, text)
    assert (status, err) == (0, "")
    for printed_value in (
        "link.autopilot = udpout:127.0.0.1:14550",
        "link.component = 191",
        "flight.margin_m = 22.5",
    ):
        assert printed_value in out
    assert re.search(r"navigation.attitude_bias_sd_deg ?= ?1.25", out)
    assert re.search(r"reports.standard = .*obstacle_distance", out) and "collision" in out


BAD_KEYS = {
    "unknown key": ("[link]\nautopilot = udpin:127.0.0.1:1\nautopylot = x\n", 3, "autopylot"),
    "unknown section": ("[links]\nautopilot = udpin:127.0.0.1:1\n", 2, "autopilot"),
    "no section": ("autopilot = udpin:127.0.0.1:1\n", 1, "autopilot"),
    "no number": ("[link]\nattitude_hz = many\n", 2, "attitude_hz"),
    "half a number": ("[link]\nattitude_hz = 50 Hz\n", 2, "attitude_hz"),
    "empty": ("[link]\nattitude_hz =\n", 2, "attitude_hz"),
    "not finite": ("[link]\nattitude_hz = nan\n", 2, "attitude_hz"),
    "infinite": ("[link]\nattitude_hz = inf\n", 2, "attitude_hz"),
    "no whole number": ("[link]\ncomponent = 1.5\n", 2, "component"),
    "too small": ("\n\n[link]\ncomponent = 0\n", 4, "component"),
    "too large": ("[link]\nsystem = 256\n", 2, "system"),
    "far too large": ("[link]\nsystem = 99999999999999999999999\n", 2, "system"),
    "negative": ("[detections]\ndelay_s = -0.1\n", 2, "delay_s"),
    "no choice": ("[reaction]\nmode = on\n", 2, "mode"),
    "no clock": ("[detections]\nclock = sundial\n", 2, "clock"),
    "no report": ("[reports]\nstandard = collision weather\n", 2, "weather"),
    "flight, unknown": ("[flight]\nmargin = 15\n", 2, "margin"),
    "flight, range": ("[flight]\nmargin_m = -1\n", 2, "margin_m"),
    "flight, no number": ("[flight]\nmargin_m = wide\n", 2, "margin_m"),
    "estimator, unknown": ("[estimator]\nnavigation.luck = 1\n", 2, "navigation.luck"),
    "estimator, range": ("[estimator]\ndetector.box_noise_px = -1\n", 2, "detector.box_noise_px"),
    "estimator, no number": ("[estimator]\ndetector.box_noise_px = x\n", 2, "detector.box_noise_px"),
    "flight, renamed": ("[flight]\ndoubt = 2\n", 2, "unknown setting flight.doubt: now flight.suspect_factor"),
    "estimator, renamed": (
        "[estimator]\nnavigation.ground_m = 2\n",
        2,
        "unknown setting navigation.ground_m: now navigation.terrain_height_sd_m",
    ),
    "twice": ("[link]\nsystem = 1\nsystem = 2\n", 3, "system"),
    "no assignment": ("[link]\nautopilot\n", 2, ""),
    "no bracket": ("[link\nsystem = 1\n", 1, ""),
    "long line": ("[link]\nautopilot = " + "x" * 5000 + "\n", 2, ""),
    "NUL": ("[link]\nsystem = 1\0\n", 2, ""),
}


@pytest.mark.parametrize("name", BAD_KEYS)
def test_bad_configurations_name_file_line_and_key(folder: Path, name: str) -> None:
    text, line, key = BAD_KEYS[name]
    status, out, err = check(folder, text)
    assert status == 2 and out == ""
    assert f"companion.ini:{line}: " in err and key in err
    assert err.count("\n") == 1 and len(err) < 500


BAD_WHOLE = {
    "increment": ("[reports]\ndistance_increment_deg = 7\n", "distance_increment_deg"),
    "px4 without its circle": ("[reaction]\nmode = px4\n", "loiter_m"),
    "link": ("[link]\nautopilot = carrier-pigeon:coop:7\n", "autopilot"),
    "port": ("[link]\nautopilot = udpin:127.0.0.1:70000\n", "autopilot"),
    "baud": ("[link]\nautopilot = serial:/dev/ttyS0:12345\n", "autopilot"),
    "source": ("[detections]\nfrom = tea leaves\n", "from"),
}


@pytest.mark.parametrize("name", BAD_WHOLE)
def test_values_that_are_none_are_errors(folder: Path, name: str) -> None:
    """Also with --check, which users run before a flight."""
    text, key = BAD_WHOLE[name]
    status, out, err = check(folder, text)
    assert status == 2 and out == ""
    assert "companion.ini" in err and key in err


def test_missing_configuration(folder: Path) -> None:
    done = call(folder / "none.ini")
    assert done.returncode == 2 and "none.ini" in done.stderr


def test_missing_camera(folder: Path) -> None:
    status, _, err = check(folder, "[camera]\nfile = elsewhere.ini\n")
    assert status == 2 and "elsewhere.ini" in err


def test_bad_camera(folder: Path) -> None:
    """Reported with the camera's file and line."""
    (folder / "camera.ini").write_text(Camera().ini() + "camera.zoom = 3\n", encoding="utf-8")
    status, _, err = check(folder, "")
    assert status == 2 and "camera.ini" in err and "zoom" in err


def test_the_camera_is_in_the_folder_of_the_configuration(folder: Path) -> None:
    """And not in the folder from which the program was called."""
    (folder / "sub").mkdir()
    (folder / "camera.ini").rename(folder / "sub" / "lens.ini")
    path = folder / "sub" / "companion.ini"
    path.write_text("[camera]\nfile = lens.ini\n", encoding="utf-8")
    assert call("--check", path).returncode == 0


# ------------------------------------------------------------------------------------------------------- begin and end


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_a_summary(make: Make, number: int) -> None:
    """Also without a message from any autopilot."""
    companion = make(usual())
    companion.start()
    companion.loop.run(0.5)
    assert companion.alive()
    ended = companion.stop(number)
    assert ended.status == 0
    assert "lost" in ended.out and "images" in ended.out


def test_nothing_moves_it_to_use_the_processor(make: Make) -> None:
    """It sleeps when idle: without an autopilot, with a TCP peer that refuses, with a missing device."""
    links = (usual()["link"]["autopilot"], f"tcp:{HOST}:{free_port(socket.SOCK_STREAM)}", "serial:/nowhere/tty:57600")
    idle = [make({**usual(), "link": {"autopilot": link}}) for link in links]
    for companion in idle:
        companion.start()
    idle[0].loop.run(2.0)
    for companion in idle:
        assert companion.alive(), companion.stop()
        assert companion.waits <= 2.0 / WAIT_S + 1
        assert companion.stop().status == 0


def test_who_hears_nobody_learns_how_to_listen(make: Make) -> None:
    """Once, after ten seconds."""
    companion = make(usual())
    companion.start()
    companion.loop.run(13.0)
    ended = companion.stop()
    assert ended.err.count("no message from an autopilot") == 1 and "0.0.0.0" in ended.err


@pytest.mark.parametrize("host, warnings", [(HOST, 0), ("0.0.0.0", 2)])
def test_who_listens_to_every_network_is_warned(make: Make, host: str, warnings: int) -> None:
    link, detections = f"udpin:{host}:{free_port()}", f"udp:{host}:{free_port()}"
    companion = make({"link": {"autopilot": link}, "detections": {"from": detections}})
    companion.start()
    companion.loop.run(0.5)
    assert companion.stop().err.count("is open to every network") == warnings


def test_end_of_standard_input_is_no_end(make: Make) -> None:
    """The autopilot still receives the report that the detector is silent."""
    companion = make({**usual(), "detections": {"from": "stdin"}})
    companion.start()
    companion.loop.run(0.7)
    assert companion.alive() and companion.waits <= 0.7 / WAIT_S + 2
    assert companion.stop().status == 0


def test_a_port_in_use_is_reported(make: Make) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind((HOST, 0))
        companion = make({"link": {"autopilot": f"udpin:{HOST}:{taken.getsockname()[1]}"}})
        done = call(companion.configuration)
    assert done.returncode > 0 and "udpin:" in done.stderr


@pytest.mark.parametrize("source", ["fifo:/nowhere/fifo", "fifo:camera.ini"])
def test_a_file_that_is_no_fifo_is_reported(make: Make, source: str) -> None:
    done = call(make({**usual(), "detections": {"from": source}}).configuration)
    assert done.returncode > 0 and "fifo:" in done.stderr


def test_a_log_that_cannot_be_written_is_reported(make: Make, tmp_path: Path) -> None:
    """The companion keeps running: the aircraft is worth more than its log."""
    (tmp_path / "file").write_text("", encoding="utf-8")
    companion = make({**usual(), "record": {"folder": tmp_path / "file"}})
    companion.start()
    companion.loop.run(0.5)
    assert companion.alive()
    ended = companion.stop()
    assert ended.status == 0 and str(tmp_path / "file") in ended.said


def test_an_old_log_is_not_overwritten(make: Make, tmp_path: Path) -> None:
    (tmp_path / "log").mkdir()
    for name in ("frames.csv", "camera.ini"):
        (tmp_path / "log" / name).write_text("a flight of yesterday\n", encoding="utf-8")
    companion = make({**usual(), "record": {"folder": tmp_path / "log"}})
    companion.start()
    companion.loop.run(0.3)
    companion.stop()
    for name in ("frames.csv", "camera.ini"):
        assert (tmp_path / "log" / name).read_text(encoding="utf-8") == "a flight of yesterday\n"


def test_on_a_terminal_one_line_is_renewed(make: Make) -> None:
    companion = make(usual())
    child, master = pty.fork()
    if child == 0:
        os.execv(PROGRAM, [PROGRAM, str(companion.configuration)])
    said = ""
    while said.count("\r") < 2:
        assert select.select([master], [], [], HANG_S)[0], said
        said += os.read(master, 65536).decode()
    os.kill(child, signal.SIGINT)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    os.close(master)
    assert "\n" not in said and "no autopilot" in said
