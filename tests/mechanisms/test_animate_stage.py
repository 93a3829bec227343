"""The stage ``animate``: films from mechanism.py alone, made again only when something changed, and its words."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from mbsd.drawing.animation.words import QUANTITIES as DRAWN
from mbsd.results.solution import Solution
from mechanisms.stages import animate as animate_stage
from mechanisms.stages.parts import stage as parts_stage
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from tests.running.make import run
from tools.fixtures import film_fixture


def test_the_stage_knows_what_can_be_drawn() -> None:
    assert set(animate_stage.QUANTITIES) == set(DRAWN)


@pytest.mark.parametrize(
    ("view", "films"),
    [
        ("", [""]),
        ("reactions", ["reactions"]),
        ("velocities, reactions", ["velocities,reactions"]),
        ("reactions,velocities", ["velocities,reactions"]),  # one film, whatever the order
        ("skeleton", ["skeleton"]),
        ("each", list(animate_stage.QUANTITIES)),
        ("all", ["all"]),
    ],
)
def test_views(view: str, films: list[str]) -> None:
    assert animate_stage.films_of(view) == films


@pytest.mark.parametrize(
    ("view", "words"),
    [("reaction", "did you mean 'reactions'"), ("each,forces", "stand alone"), ("../x", "there is no view '../x'")],
)
def test_unknown_views_are_refused(view: str, words: str) -> None:
    with pytest.raises(UserError, match=words):
        animate_stage.films_of(view)


def test_make_hands_the_view_over_as_it_is() -> None:
    done = run("make", "-o", "install", "animate-four-bar", "VIEW=$(shell touch stolen);x")
    assert done.returncode != 0
    assert "there is no view" in done.stderr
    assert not Path("stolen").exists()


KILLED = """
import os, signal
from mbsd.drawing.animation import encoders
from mechanisms.stages import animate as stage
run = encoders._run
def killed(path, command, pictures):
    run(path, command, pictures)  # the first round is a whole film of its own
    os.kill(os.getpid(), signal.SIGKILL)
encoders._run = killed
stage.run("four_bar", "skeleton")
"""


def test_the_rest_of_a_killed_run_is_removed_by_the_next(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a film stayed under a hidden name for ever, a new one after each kill."""
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    done = subprocess.run([sys.executable, "-c", KILLED], cwd=ROOT, capture_output=True, check=False)
    assert done.returncode == -signal.SIGKILL
    folder = tmp_path / "four_bar"
    assert [path for path in folder.iterdir() if path.suffix == ".mp4" and path.name.startswith(".")]
    animate_stage.run("four_bar", "skeleton")
    films = {path.name for path in folder.iterdir() if path.is_file()}
    assert films == {"animation-skeleton.mp4", "animation-skeleton.gif"}


def test_a_film_is_made_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    animate_stage.run("four_bar", "velocities")
    out = Out("four_bar")
    films = [out.animation("velocities", suffix) for suffix in (".mp4", ".gif")]
    assert all(film.stat().st_size > 10_000 for film in films)
    assert not out.parts.exists()
    assert not out.motion.exists()
    said = capsys.readouterr().out
    assert "30 pictures, 1.0 s" in said
    before = [film.stat().st_mtime_ns for film in films]
    animate_stage.run("four_bar", "velocities")
    assert "nothing to do" in capsys.readouterr().out
    assert [film.stat().st_mtime_ns for film in films] == before
    films[1].write_bytes(b"damaged")
    animate_stage.run("four_bar", "velocities")
    assert films[1].stat().st_size > 10_000
    assert {path.name for path in out.folder.iterdir()} == {
        "animation-velocities.mp4",
        "animation-velocities.gif",
        ".stamps",
    }


def test_bodies_have_the_masses_of_their_parts_where_these_are_current(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    out = film_fixture.write()
    drawn: list[dict[str, float]] = []

    def draw(solution: Solution, path: Path, words: str, parts: object) -> None:
        path.write_bytes(b"film")
        drawn.append({name: body.mass for name, body in solution.mechanism.bodies.items() if name != "ground"})

    monkeypatch.setattr(animate_stage, "_draw", draw)
    animate_stage.run("four_bar", "skeleton")
    assert (
        "the parts are of an older state, so their masses do not count; make parts-four-bar" in capsys.readouterr().out
    )
    assert 0.1 not in drawn[0].values()
    monkeypatch.setattr(parts_stage, "are_current", lambda name: True)
    animate_stage.run("four_bar", "skeleton")  # the same sources, other masses
    assert "four_bar: masses of the parts: crank, coupler, rocker\n" in capsys.readouterr().out
    assert set(drawn[-1].values()) == {0.1}
    animate_stage.run("four_bar", "skeleton")
    assert "nothing to do" in capsys.readouterr().out
    assert out.parts.is_file()
