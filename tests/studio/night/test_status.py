"""``mbsd status`` says which films are done, and which of these are of an older version of their machine."""

from __future__ import annotations

from pathlib import Path

import pytest

from render import freshness
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of
from studio.night import status
from studio.night.runs import FilmRecord, NightRecord, Run

NAMES = ["four_bar", "pendulum", "trammel"]


@pytest.fixture
def recorded(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> NightRecord:
    """Return the record of a finished run; the trammel's film comes from elsewhere."""
    monkeypatch.setattr(freshness, "current_names", set)
    for name in NAMES:
        out = Out(name)
        for path in (out.motion, out.film("draft")):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"as {name} was filmed")
        if name != "trammel":
            Stage(out, "film-draft", key_of(out.motion), [out.film("draft")]).record()
    films = {name: FilmRecord(outcome="done", steps={}, all=30) for name in NAMES}
    return NightRecord(process=1, host="here", preset="draft", started="", updated="", ended="done", films=films)


def _states(recorded: NightRecord) -> dict[str, str]:
    lines = [line.split() for line in status.words(Run(1), recorded, alive=False)]
    return {line[0]: " ".join(line[2:]) for line in lines if line and line[0] in NAMES}


def test_films_of_the_machines_as_they_are_are_done(recorded: NightRecord) -> None:
    assert _states(recorded) == dict.fromkeys(NAMES, "done")


def test_a_film_of_the_motion_before_is_marked(recorded: NightRecord) -> None:
    Out("pendulum").motion.write_text("solved again")
    assert _states(recorded) == {**dict.fromkeys(NAMES, "done"), "pendulum": "done, of an older version"}


def test_a_film_is_marked_whose_machine_is_not_solved_again_yet(
    recorded: NightRecord, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(freshness, "current_names", lambda names: {"pendulum"})
    assert _states(recorded)["four_bar"] == "done, of an older version"
    assert _states(recorded)["pendulum"] == "done"


def test_films_that_failed_are_not_asked(recorded: NightRecord) -> None:
    recorded.films["pendulum"].outcome = "failed"
    Out("pendulum").motion.write_text("solved again")
    assert _states(recorded)["pendulum"] == "failed:"
