"""Scales of models: valid words, and the places of their files."""

from __future__ import annotations

from pathlib import Path

import pytest

from shared.stage.errors import UserError
from shared.stage.paths import Out
from shared.stage.scale import scale_of


@pytest.mark.parametrize(
    ("text", "shown", "ratio"),
    [
        ("1:20", "1:20", 0.05),
        ("1/20", "1:20", 0.05),
        (" 1 : 20 ", "1:20", 0.05),
        ("0.05", "1:20", 0.05),
        ("2:40", "1:20", 0.05),
        ("1:2.5", "2:5", 0.4),
        ("2:1", "2:1", 2.0),
        ("1", "1:1", 1.0),
    ],
)
def test_a_scale_may_be_written_in_several_ways(text: str, shown: str, ratio: float) -> None:
    scale = scale_of(text)
    assert scale is not None
    assert (str(scale), scale.ratio) == (shown, ratio)


def test_nothing_is_the_machine_itself() -> None:
    assert scale_of("") is None


@pytest.mark.parametrize("text", ["big", "1:0", "0", "-1:20", "1:20:3", "1:1000000", "1e-2", "1:", "nan"])
def test_invalid_scales_are_refused_with_the_remedy(text: str) -> None:
    with pytest.raises(UserError, match=r"is not a scale between 1:10000 and 100:1; .* SCALE=1:20, 1/20 or 0\.05"):
        scale_of(text)


def test_a_number_above_one_is_asked_about() -> None:
    with pytest.raises(UserError, match=r"SCALE=1:20 for a small model, 20:1 for a large one"):
        scale_of("20")


def test_models_have_folders_of_their_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    machine, small, large = (Out("four_bar", scale_of(text)) for text in ("", "1:20", "2:1"))
    assert small.parts == machine.folder / "scale_1_20" / "parts" / "parts.json"
    assert large.print_folder == machine.folder / "scale_2_1" / "print"
    assert machine.parts == machine.folder / "parts" / "parts.json"
    assert [out.title for out in (machine, small)] == ["four_bar", "four_bar at 1:20"]
