"""Names that version 0.4.0 replaced: every old one is refused, and the error reports the new one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import goe
import pytest
from goe import _renamed
from goe_tools import renamed
from goe_tools.__main__ import main
from goe_tools.logs.estimates import LABELS, NUMBERS, read_estimates
from goe_tools.logs.obslog import LogError


def settings_now() -> set[str]:
    flight = {f"flight.{field.name}" for field in dataclasses.fields(goe.FlightSettings)}
    return {row.name for row in goe.setting_rows()} | flight


def test_the_programs_and_the_package_have_one_list() -> None:
    settings = {before: now for before, now in renamed.names().items() if "." in before}
    assert settings == _renamed.SETTINGS and len(settings) == 30
    assert set(renamed.names()) - set(settings) == {"--method refined", "n_used", "misfit"}


def test_new_names_exist_and_old_ones_do_not() -> None:
    assert set(_renamed.SETTINGS.values()) <= settings_now()
    assert not set(_renamed.SETTINGS) & settings_now()
    assert {renamed.names()["n_used"], renamed.names()["misfit"]} == {"images_used", "nis_ratio"}


@pytest.mark.parametrize("owner", sorted(_renamed.FIELDS))
def test_new_attributes_exist_and_old_ones_do_not(owner: str) -> None:
    kind = goe if owner == "goe" else getattr(goe, owner, None) or getattr(goe.flight, owner)
    names = {*dir(kind), *getattr(kind, "__dataclass_fields__", ())}
    assert set(_renamed.FIELDS[owner].values()) <= names
    assert not set(_renamed.FIELDS[owner]) & names


@pytest.mark.parametrize("name", [name for name in _renamed.SETTINGS if not name.startswith("flight.")])
def test_settings_by_name(name: str) -> None:
    with pytest.raises(goe.SettingError, match=f"^{name}: unknown setting, now {_renamed.SETTINGS[name]}$"):
        goe.Settings.from_names({name: 1.0})


HAZARD = goe.Hazard(1.0, 0.1, goe.Length(2.0, 0.2), None, 0.5)
USES: list[tuple[Callable[[], Any], type[Exception], str]] = [
    (lambda: goe.Plan, AttributeError, "goe.Plan: now goe.Intent"),
    (lambda: goe.Settings().refined, AttributeError, "Settings.refined: now Settings.filter"),
    (lambda: goe.Settings().navigation.slope, AttributeError, "now Navigation.terrain_slope_sd"),
    (lambda: setattr(goe.Settings().detector, "box_px", 1.0), AttributeError, "now Detector.box_noise_px"),
    (lambda: goe.Camera(cut_share=0.1), TypeError, "Camera.cut_share: now Camera.truncation_rel"),
    (lambda: goe.FlightSettings(doubt=2.0), TypeError, "now FlightSettings.suspect_factor"),
    (lambda: goe.DecisionRule(act_s=5.0), TypeError, "DecisionRule.act_s: now DecisionRule.act_within_s"),
    (lambda: goe.Rule(1.0, 1.0).doubt, AttributeError, "Rule.doubt: now Rule.suspect_factor"),
    (lambda: HAZARD.violation, AttributeError, "Hazard.violation: now Hazard.conflict_probability"),
    (lambda: HAZARD.soonest_s, AttributeError, "now Hazard.earliest_tcpa_s"),
    (lambda: goe.ImageNoise(pixel_px=1.0), TypeError, "ImageNoise.pixel_px: now ImageNoise.pixel_sd_px"),
]


@pytest.mark.parametrize(("use", "kind", "words"), USES)
def test_attributes_and_keywords(use: Callable[[], Any], kind: type[Exception], words: str) -> None:
    with pytest.raises(kind, match=words):
        use()


def test_other_unknown_names_are_refused_as_before() -> None:
    with pytest.raises(AttributeError, match="'Hazard' has no attribute 'nothing'"):
        _ = HAZARD.nothing  # type: ignore[attr-defined]
    with pytest.raises(TypeError, match="unexpected keyword argument"):
        goe.DecisionRule(nothing=1.0)  # type: ignore[call-arg]


def test_a_log_of_estimates(tmp_path: Path) -> None:
    header = ",".join([*LABELS, *NUMBERS]).replace("images_used", "n_used")
    (tmp_path / "estimates.csv").write_text(header + "\n")
    with pytest.raises(LogError, match=r"images_used: unknown column n_used: now images_used"):
        read_estimates(tmp_path / "estimates.csv")


SET = (["--set", "detector.point_px=1"], "unknown setting detector.point_px: now detector.point_noise_px")
METHOD = (["--method", "refined"], "unknown value refined: now --method filter")


@pytest.mark.parametrize(("command", "given"), [("view", SET), ("view", METHOD), ("noise", SET)])
def test_commands(
    command: str, given: tuple[list[str], str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words, reported = given
    with pytest.raises(SystemExit):
        main([command, str(tmp_path), *words])
    assert reported in capsys.readouterr().err
