"""The table for pilots."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from bench.reference.compare import run_replay  # noqa: F401  (the stand-in is run as the program would be)
from goe_tools.__main__ import main
from goe_tools.logs.estimates import LABELS, NUMBERS, Estimate, read_estimates
from goe_tools.logs.obslog import LogError
from goe_tools.logs.table import chosen, measured

ROOT = Path(__file__).resolve().parents[2]

FIELDS = (*LABELS, *NUMBERS)
HEADER = ",".join(FIELDS)


def row(t_s: float, track: int, status: str, model: str, **values: float) -> str:
    numbers = ["" if name not in values else repr(values[name]) for name in NUMBERS]
    return ",".join([repr(t_s), str(track), status, model, "8" if model != "none" else "0", *numbers])


LINE = {
    "x0_m": -30.0, "x0_sd_m": 0.5, "z0_m": 200.0, "z0_sd_m": 2.0, "x_m": -30.0, "x_sd_m": 0.5, "z_m": 120.0,
    "z_sd_m": 2.0, "width_m": 12.1, "width_sd_m": 0.21, "length_m": 20.5, "length_sd_m": 0.6,
    "orientation_deg": 20.2, "orientation_sd_deg": 0.25,
}  # fmt: skip


@pytest.fixture
def estimates(tmp_path: Path) -> Path:
    lines = [HEADER, row(0.0, 1, "converging", "none"), row(1.0, 1, "ok", "line", **LINE)]
    lines += [row(1.0, 2, "converging", "none"), row(2.0, 1, "stale", "line", **LINE)]
    path = tmp_path / "estimates.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


def test_text_of_the_table(estimates: Path, tmp_path: Path, capsys) -> None:
    truth = tmp_path / "truth.csv"
    truth.write_text(
        "id,static,center_n_m,center_e_m,ground_d_m,width_m,length_m,height_m,heading_deg,x0_m,z0_m,orientation_deg\n"
        "1,1,1,2,3,12,20,5,7,-29,201,19\n"
    )
    assert main(["table", str(estimates), "--truth", str(truth)]) == 0
    output = capsys.readouterr().out
    assert "120.0 ±2.0 m" in output
    assert "30.00 ±0.50 m left" in output
    assert "* stale" in output
    assert "12.10 ±0.21 m" in output and "12.00 m" in output and "+0.10 m" in output
    assert "20.20 ±0.25°" in output and "+1.20°" in output
    assert "obstacle 2: no estimate in 1 images (last: converging)" in output


@pytest.mark.parametrize(
    ("doubt", "words"),
    [("1,moves", "suspect: moves"), ("1,convention", "suspect: convention"), ("0,late", "poses late")],
)
def test_a_suspect_estimate_is_marked(doubt: str, words: str, tmp_path: Path, capsys) -> None:
    path = tmp_path / "estimates.csv"
    path.write_text(f"{HEADER},suspect,reason\n{row(1.0, 1, 'ok', 'line', **LINE)},{doubt}\n")
    assert main(["table", str(path)]) == 0
    assert re.search(rf" front edge +{words} *$", capsys.readouterr().out, re.MULTILINE)


def test_the_width_across_the_line_of_sight_has_no_truth(estimates: Path, tmp_path: Path, capsys) -> None:
    truth = tmp_path / "truth.csv"
    truth.write_text(
        "id,static,center_n_m,center_e_m,ground_d_m,width_m,length_m,height_m,heading_deg\n1,1,1,2,3,12,20,5,7\n"
    )
    estimates.write_text(estimates.read_text().replace(",line,", ",prism,"))
    assert main(["table", str(estimates), "--truth", str(truth)]) == 0
    output = capsys.readouterr().out
    assert re.search(r"width across the line of sight +12\.10 ±0\.21 m +- +- *$", output, re.MULTILINE)


def test_without_truth(estimates: Path, capsys) -> None:
    assert main(["table", str(estimates)]) == 0
    assert "120.0 ±2.0 m" in capsys.readouterr().out


def test_one_track(estimates: Path, capsys) -> None:
    assert main(["table", str(estimates), "--id", "2"]) == 0
    assert "obstacle 1" not in capsys.readouterr().out
    assert main(["table", str(estimates), "--id", "5"]) == 2
    assert "no track 5" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("value", "sigma", "text"),
    [
        (1234.5, 123.0, "1234 ±123"),
        (123.456, 1.26, "123.5 ±1.3"),
        (5.1234, 0.0121, "5.12 ±0.01"),
        (5.0, 0.0, "5.00 ±0.00"),
    ],
)
def test_digits_follow_the_sigma(value: float, sigma: float, text: str) -> None:
    assert measured(Estimate("ok", values={"z_m": value, "z_sd_m": sigma}), "z_m") == text


def test_rows_are_spread() -> None:
    rows = [(float(k), 1, Estimate("ok", "disc")) for k in range(100)]
    assert [t for t, _, _ in chosen(rows, 4)] == [0.0, 33.0, 66.0, 99.0]
    assert len(chosen(rows[:3], 4)) == 3
    assert chosen(rows, 1)[0][0] == 99.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", " empty: no header line"),
        (HEADER.replace(",x_m", "") + "\n", "1: x_m: column is missing"),
        (HEADER + "\n" + row(1.0, 1, "ok", "disc", x0_m=1.0).replace("1.0,1,", "soon,1,") + "\n", "2: t_s: 'soon'"),
        (
            HEADER + "\n" + row(1.0, 1, "ok", "disc", x0_m=1.0) + ",3\n",
            f"2: {FIELDS[-1]}: {len(FIELDS) + 1} fields under {len(FIELDS)} columns",
        ),
        (
            HEADER + "\n" + row(1.0, 1, "ok", "disc")[:-3] + "\n",
            f"2: {FIELDS[-3]}: {len(FIELDS) - 3} fields under {len(FIELDS)} columns",
        ),
    ],
)
def test_bad_estimates(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "estimates.csv"
    path.write_text(text)
    with pytest.raises(LogError) as error:
        read_estimates(path)
    assert str(error.value).startswith(f"{path}:{message}")


def test_the_demo(replay: Path, tmp_path: Path, capsys) -> None:
    import subprocess

    out, folder = tmp_path / "out.csv", ROOT / "tests" / "data" / "corner"
    subprocess.run([replay, "--out", out, folder], check=True)
    assert main(["table", str(out), "--truth", str(folder / "truth.csv")]) == 0
    output = capsys.readouterr().out
    assert "suspect:" not in output
    assert re.search(r" upright +$", output, re.MULTILINE) and re.search(r" box +$", output, re.MULTILINE)
    errors = [line.split()[-2] for line in output.splitlines() if line.startswith(("width of", "length of", "height "))]
    assert len(errors) == 3
    assert all(abs(float(error)) < 1.0 for error in errors)
