"""Night shift: its board, its status, and how long a step may be silent."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from render import freshness
from render.blender.process import FLOOR, KERNELS, TIMES
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of
from studio.night import status
from studio.night.plan.steps import FILM, PROBE, STEPS, Board, followers
from studio.night.process import STAGE, TWICE, limit
from studio.night.runs import FilmRecord, NightRecord, Run

# The order of steps: every one runs once after those that it needs, the render never waits, probes come first.


NAMES = [f"m{number}" for number in range(4)]
NEEDS = {step.name: step.needs for step in STEPS}
RENDERS = {step.name: step.renders for step in STEPS}
WORK = [(name, step.name) for name in NAMES for step in STEPS]


def play(board: Board, bad: set[tuple[str, str]], data: st.DataObject, cores: int) -> list[tuple[str, str]]:
    """Run the board as the coordinator does, with steps that end in any order; the steps as they were started."""
    running: list[tuple[str, str]] = []
    order: list[tuple[str, str]] = []
    while not board.is_over():
        renders = [job for job in running if RENDERS[job[1]]]
        for kind, places in ((True, 1 - len(renders)), (False, cores - (len(running) - len(renders)))):
            for name, step in list(board.ready(kind))[: max(places, 0)]:
                board.start(name, step)
                running.append((name, step))
                order.append((name, step))
        assert not any(board.ready(True)) or any(RENDERS[step] for _, step in running)
        assert running
        job = data.draw(st.sampled_from(sorted(running)))
        running.remove(job)
        (board.fail if job in bad else board.finish)(*job)
    return order


@given(st.data(), st.sets(st.sampled_from(WORK), max_size=3), st.integers(1, 5))
def test_every_step_runs_once_after_what_it_needs_and_failures_stay_with_their_mechanism(data, bad, cores):
    board = Board(NAMES)
    order = play(board, bad, data, cores)
    assert len(order) == len(set(order))
    for name, step in order:
        before = order[: order.index((name, step))]
        assert {(name, need) for need in NEEDS[step]} <= set(before) - bad
    for name in NAMES:
        own = {step for other, step in bad if other == name and (name, step) in order}
        blocked = {after for step in own for after in followers(step)}
        assert {step for other, step in order if other == name} >= set(NEEDS) - blocked
        assert board.outcome(name) == ("failed" if own else "done")


@given(st.data(), st.integers(1, 5))
def test_every_probe_comes_before_the_first_film(data, cores):
    order = [step for _, step in play(Board(NAMES), set(), data, cores)]
    assert FILM not in order[: len(order) - order[::-1].index(PROBE)]


def test_a_probe_that_can_never_be_made_holds_no_film_up():
    board = Board(["a", "b"])
    board.fail("a", "parts")
    for step in ("parts", "solve", "shot", "clearance", PROBE):
        board.finish("b", step)
    assert list(board.ready(True)) == [("b", FILM)]
    assert board.steps_of("a")[FILM] == "blocked"


@given(st.sets(st.sampled_from(list(NEEDS))))
def test_steps_after_a_changed_step_are_looked_at_again(fresh):
    board = Board(["a"], {"a": fresh})
    for step, state in board.steps_of("a").items():
        stale = step not in fresh or any(step in followers(other) for other in set(NEEDS) - fresh)
        assert state == ("waiting" if stale else "fresh")


def test_steps_beside_the_render_come_in_the_order_in_which_it_needs_them():
    board = Board(["a", "b"])
    assert list(board.ready(False)) == [("a", "parts"), ("b", "parts")]
    for name in "ab":
        board.finish(name, "parts")
        board.finish(name, "solve")
    assert [step for _, step in board.ready(False)] == ["shot", "shot", "clearance", "clearance", "plots", "plots"]


def test_a_mechanism_that_another_process_has_holds_no_film_up():
    board = Board(["a", "b"])
    for step in ("parts", "solve", "shot", "clearance", PROBE):
        board.finish("b", step)
    assert list(board.ready(True)) == []
    board.away.add("a")
    assert list(board.ready(True)) == [("b", FILM)]
    assert not board.is_over()


# ``mbsd status`` says which films are done, and which of these are of an older version of their machine.


FILMED = ["four_bar", "pendulum", "trammel"]


@pytest.fixture
def recorded(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> NightRecord:
    """Return the record of a finished run; the trammel's film comes from elsewhere."""
    monkeypatch.setattr(freshness, "current_names", set)
    for name in FILMED:
        out = Out(name)
        for path in (out.motion, out.film("draft")):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"as {name} was filmed")
        if name != "trammel":
            Stage(out, "film-draft", key_of(out.motion), [out.film("draft")]).record()
    films = {name: FilmRecord(outcome="done", steps={}, all=30) for name in FILMED}
    return NightRecord(process=1, host="here", preset="draft", started="", updated="", ended="done", films=films)


def _states(recorded: NightRecord) -> dict[str, str]:
    lines = [line.split() for line in status.words(Run(1), recorded, alive=False)]
    return {line[0]: " ".join(line[2:]) for line in lines if line and line[0] in FILMED}


def test_films_of_the_machines_as_they_are_are_done(recorded: NightRecord) -> None:
    assert _states(recorded) == dict.fromkeys(FILMED, "done")


def test_a_film_of_the_motion_before_is_marked(recorded: NightRecord) -> None:
    Out("pendulum").motion.write_text("solved again")
    assert _states(recorded) == {**dict.fromkeys(FILMED, "done"), "pendulum": "done, of an older version"}


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


# Longest silence of a step.


def test_a_render_has_ten_times_a_picture_twice_over_because_its_stage_starts_blender_again(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.delenv("MBSD_PATIENCE", raising=False)
    assert limit(True, 100.0, 3) == pytest.approx(TWICE * TIMES * 100.0)
    assert limit(True, 0.1, 3) == pytest.approx(TWICE * FLOOR)
    assert limit(True, None, 3) == pytest.approx(TWICE * FLOOR)
    assert TWICE > 2


def test_the_first_picture_has_time_for_the_kernels_of_a_gpu(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("MBSD_PATIENCE", raising=False)
    assert limit(True, 0.1, 0) == pytest.approx(TWICE * KERNELS)


def test_steps_without_pictures_have_an_hour_whatever_a_picture_takes(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("MBSD_PATIENCE", raising=False)
    assert limit(False, 1000.0, 0) == STAGE
    monkeypatch.setenv("MBSD_PATIENCE", str(FLOOR / 60))
    assert limit(False, None, 0) == pytest.approx(STAGE / 60)
