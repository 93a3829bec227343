"""The forecast: time, hour, disk and energy from pictures that lack and the seconds of those that were made."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from pathlib import Path
from types import SimpleNamespace

import pytest

from render.presets import PRESETS
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from studio.night import background, night, runs
from studio.night import forecast as told
from studio.night.coordinator import Coordinator
from studio.night.forecast import START, Forecast, Frames, forecast
from studio.night.plan.options import Options
from studio.night.plan.steps import FILM, STEPS
from tools.fixtures import film_fixture

PREVIEW = PRESETS["preview"]
NOW = datetime(2026, 3, 1, 22, 30)


def film(name: str, total: int, done: int, each: float | None, size: float = 1e6) -> Frames:
    keys = [f"{name}{number}" for number in range(total)]
    files = frozenset(f"{key}-abc.png" for key in keys[:done])
    return Frames(name, PREVIEW, frozenset(keys), each, size, files)


def test_the_forecast_is_the_sum_of_what_lacks(tmp_path: Path):
    outlook = forecast([film("a", 100, 40, 10.0), film("b", 50, 50, 3.0), film("c", 20, 0, 5.0)], 0, PREVIEW, tmp_path)
    assert (outlook.films, outlook.pictures, outlook.unknown) == (2, 80, 0)
    assert outlook.seconds == pytest.approx(60 * 10.0 + 20 * 5.0 + 2 * START)
    assert outlook.bytes == pytest.approx((60 + 0.1 * 100 + 20 + 0.1 * 20) * 1e6)
    assert outlook.fits


def test_a_film_that_was_not_measured_counts_as_the_others_do_on_average(tmp_path: Path):
    outlook = forecast([film("a", 10, 0, 10.0), film("b", 10, 0, 20.0), film("c", 10, 0, None)], 1, PREVIEW, tmp_path)
    assert outlook.seconds == pytest.approx(10 * (10.0 + 20.0 + 15.0) + 3 * START)
    words = outlook.words(NOW)
    assert words.startswith("4 films, 30 frames to render: 7 min 48 s, finished at 22:37;")
    assert "1 film not measured" in words
    assert "1 film not counted" in words


def test_energy_and_the_day_are_told():
    outlook = Forecast(2, 1000, 36_000.0, 0, 0, 2.5e9, 80e9)
    words = outlook.words(NOW, 85.0)
    assert words == (
        "2 films, 1000 frames to render: 10 h 00 min, finished on Monday 02 March at 08:30; 850 Wh at 85 W; "
        "2.5 GB of disk of 80.0 GB free"
    )
    assert told.energy(3.6e6 * 12.34) == "12.3 kWh"


def test_a_disk_that_is_too_small_is_seen_also_where_nothing_was_measured(tmp_path: Path):
    assert not Forecast(1, 10, None, 1, 0, 1e9, 1.1e9).fits
    assert Forecast(1, 10, None, 1, 0, 1e9, 1.3e9).fits
    assert Forecast(0, 0, 0.0, 0, 0, 0.0, 1e6).fits
    outlook = forecast([film("a", 10, 0, None, size=0.0)], 0, PREVIEW, tmp_path / "not there yet")
    assert outlook.seconds is None
    assert outlook.bytes == pytest.approx(11 * told.BYTES * 1280 * 720)
    assert "hour" not in outlook.words(NOW)


def test_nothing_left_is_told_as_such(tmp_path: Path):
    assert forecast([film("a", 10, 10, 2.0)], 0, PREVIEW, tmp_path).words(NOW, 85.0) == "every frame is there"


def test_the_pace_of_a_run_replaces_that_of_the_probe(out_root: Path, monkeypatch: pytest.MonkeyPatch):
    clock = [0.0]
    monkeypatch.setattr("studio.night.forecast.time.monotonic", lambda: clock[0])
    pictures = film("a", 10, 0, 10.0, size=0.0)
    folder = out_root / "a" / "frames" / "preview"
    folder.mkdir(parents=True)
    for number in range(4):
        assert pictures.each == (10.0 if number < 3 else 2.0)
        clock[0] += 2.0
        (folder / f"a{number}-abc.png").write_bytes(b"x" * 1000)
        (folder / f".a{number}.part.png").touch()
        assert pictures.look()
        assert not pictures.look()
    assert (pictures.existing, pictures.left, pictures.size) == (4, 6, 1000.0)
    pictures.begin()
    assert pictures.each == 10.0


def test_only_a_disk_that_surely_cannot_hold_the_pictures_is_too_small(tmp_path: Path):
    films = [film("a", 100, 40, 10.0, size=1e6), film("b", 10, 0, None, size=0.0)]
    outlook = forecast(films, 3, PREVIEW, tmp_path)
    assert outlook.least == pytest.approx(60 * 0.7e6 + 10 * 0.3 * 1280 * 720)
    assert outlook.least < outlook.bytes
    for free, can in ((outlook.least + told.RESERVE, True), (outlook.least + told.RESERVE - 1, False), (None, True)):
        assert replace(outlook, free=free).can_fit == can
    assert replace(outlook, pictures=0, free=0.0).can_fit


def test_a_night_that_the_disk_cannot_hold_is_refused_with_the_numbers_or_begun_anyway(
    out_root: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    film_fixture.write(Shot(turns=2, seconds_per_turn=1.0), "four_bar")
    began: list[str] = []
    monkeypatch.setattr(night, "fresh_steps", lambda _: {})
    monkeypatch.setattr(night, "_table", lambda *_: None)
    monkeypatch.setattr(Coordinator, "go", lambda self: began.append("run") or True)
    monkeypatch.setattr(background, "_launch", lambda *_: began.append("start") or "")
    monkeypatch.setattr(background, "_begun", lambda _: runs.Run(1))
    monkeypatch.setattr(told.shutil, "disk_usage", lambda _: SimpleNamespace(free=250e6))
    asked = Options(("four_bar",), PRESETS["final"])
    assert night.run(asked) == 1
    said = capsys.readouterr().err
    assert "pictures of final are still to be made and need " in said
    assert "has 250 MB free, of which 200 MB stay free" in said
    assert "error: four_bar" not in said
    with pytest.raises(UserError, match="ANYWAY=1 begins all the same"):
        background.start(asked)
    assert not began
    night.run(replace(asked, anyway=True))
    background.start(replace(asked, anyway=True))
    night.run(replace(asked, preset=PRESETS["draft"]))
    assert began == ["run", "start", "run"]


def test_a_disk_that_turns_out_too_small_when_the_forecast_stands_ends_the_night_before_its_films(
    out_root: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    film_fixture.write(Shot(turns=2, seconds_per_turn=1.0), "four_bar")
    monkeypatch.setattr(
        night, "fresh_steps", lambda _: {"four_bar": [step.name for step in STEPS if step.name != FILM]}
    )
    monkeypatch.setattr(night, "refuse_before_start", lambda *_: None)
    monkeypatch.setattr(told.shutil, "disk_usage", lambda _: SimpleNamespace(free=250e6))
    assert night.run(Options(("four_bar",), PRESETS["final"], python="/bin/false")) == 1
    said = capsys.readouterr()
    assert "forecast: 1 film, " in said.out
    assert "ANYWAY=1 begins all the same" in said.err
    outcome = runs.read(runs.Run(1))
    assert outcome is not None
    assert outcome.ended == "failed"
    assert outcome.forecast.startswith("not begun: ")
    assert outcome.films["four_bar"].steps[FILM] == "waiting"
