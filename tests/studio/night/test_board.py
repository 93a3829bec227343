"""The order of steps: every one runs once after those that it needs, the render never waits, probes come first."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.night.plan.steps import FILM, PROBE, STEPS, Board, followers

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
