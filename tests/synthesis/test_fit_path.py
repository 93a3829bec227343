"""Path synthesis: known designs are found again, conditions hold, a published line is beaten, refusals say why."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, SynthesisError, fit_path
from tests.synthesis.test_path_tangents import geared
from tools.models import linkages

REFERENCE = Path(__file__).parents[1] / "published" / "reference"
BOUNDS = {
    "crank": (0.05, 0.2),
    "coupler": (0.2, 0.5),
    "rocker": (0.2, 0.5),
    "D": ((0.2, 0.6), (-0.1, 0.1)),
    "P": ((0.0, 0.4), (-0.2, 0.2)),
}
KNOWN = {"crank": 0.12, "coupler": 0.35, "rocker": 0.28, "D": (0.38, -0.02), "P": (0.25, 0.08)}


def four_bar(
    crank: float = 0.1,
    coupler: float = 0.38,
    rocker: float = 0.3,
    D: tuple[float, float] = (0.4, 0.02),
    P: tuple[float, float] = (0.2, 0.1),
) -> Mechanism:
    return linkages.four_bar(D, crank, coupler, rocker, (45, 90), masses=(None, 0.3, None), traced=P)


def traced(m: Mechanism, count: int = 16, name: str = "P") -> np.ndarray:
    point = m.sweep(steps=count).point(name)
    return np.column_stack([point.x, point.y])[:-1]


def test_a_known_design_is_found_from_its_path_alone() -> None:
    fit = fit_path(four_bar(), traced(four_bar(**KNOWN)), BOUNDS, seed=1)
    assert fit.largest < 1e-12
    for name, value in KNOWN.items():
        np.testing.assert_allclose(fit.values[name], value, atol=1e-9)
    again = traced(fit.mechanism)
    np.testing.assert_allclose(again, traced(four_bar(**KNOWN)), atol=1e-9)
    coupler = fit.mechanism.bodies["coupler"]
    assert coupler.com == (coupler.length / 2, 0.0)  # still a uniform rod


@pytest.mark.parametrize(("scale", "turn"), [(0.01, 0.4), (6.0, -2.0)])
def test_size_and_turn_of_the_world_do_not_matter(scale: float, turn: float) -> None:
    """The same task, scaled and turned about the pivot A, is solved as well with its bounds turned along."""
    matrix = scale * np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    points = traced(four_bar(**KNOWN), 10) @ matrix.T
    start = four_bar(0.1 * scale, 0.38 * scale, 0.3 * scale, tuple(matrix @ (0.4, 0.02)), (0.2 * scale, 0.1 * scale))
    start.start_near(coupler=45 + np.degrees(turn), rocker=90 + np.degrees(turn))
    corner = matrix @ (0.4, 0.0)
    vary = {name: (low * scale, high * scale) for name, (low, high) in list(BOUNDS.items())[:3]}
    vary["D"] = tuple((value - 0.1 * scale, value + 0.1 * scale) for value in corner)
    vary["P"] = ((0.0, 0.4 * scale), (-0.2 * scale, 0.2 * scale))
    fit = fit_path(start, points, vary, seed=1)
    assert fit.largest < 1e-9 * scale


def test_times_and_a_free_start_are_met() -> None:
    wanted, m = traced(four_bar(**KNOWN), 12), four_bar()
    times = np.linspace(0, 1, 13)[:-1]
    fit = fit_path(m, np.roll(wanted, -5, axis=0), BOUNDS, times=times, free_start=True, seed=3)
    assert fit.largest < 1e-9
    assert fit.shift == pytest.approx(5 / 12, abs=1e-7)
    fixed = fit_path(m, np.roll(wanted, -5, axis=0), BOUNDS, times=times, seed=3, starts=1, generations=40)
    assert fixed.largest > 0.01  # the crank would have to be elsewhere


def test_conditions_hold() -> None:
    points = np.array([(0.05, 0.3), (0.15, 0.32), (0.25, 0.3), (0.3, 0.22)])
    free = fit_path(four_bar(), points, BOUNDS, seed=2, starts=1, generations=60)
    held = fit_path(
        four_bar(), points, BOUNDS, seed=2, starts=1, generations=30, grashof=True, least_transmission=np.radians(50)
    )
    assert held.least_transmission >= np.radians(50)
    assert held.mean >= free.mean - 1e-9
    solution = held.mechanism.sweep(steps=360)
    between = solution.body("coupler").theta - solution.body("rocker").theta
    assert np.arccos(np.abs(np.cos(between))).min() == pytest.approx(held.least_transmission, abs=1e-3)
    bodies, far = held.mechanism.bodies, held.mechanism.joints["D"].i
    lengths = [*(bodies[name].length for name in ("crank", "coupler", "rocker")), np.hypot(far.x, far.y)]
    assert min(lengths) + max(lengths) <= sum(lengths) / 2


def test_a_closed_curve_is_the_whole_path() -> None:
    """An arc of the path is met by many designs; the whole path tells which."""
    wanted = traced(four_bar(**KNOWN), 48)
    whole = fit_path(four_bar(), wanted, BOUNDS, closed=True, seed=1, starts=1, generations=80)
    path = whole.path[:-1]
    away = np.hypot(*(path[:, None] - traced(four_bar(**KNOWN), 720)).transpose(2, 0, 1)).min(axis=1)
    assert away.max() < 3e-3 * np.hypot(*np.ptp(wanted, axis=0))


def test_numbers_of_the_authors_function_are_varied() -> None:
    fit = fit_path(four_bar(), traced(four_bar(**KNOWN), 10), BOUNDS, build=four_bar, seed=1, starts=1)
    assert fit.largest < 1e-9
    np.testing.assert_allclose(fit.values["D"], KNOWN["D"], atol=1e-6)


def test_what_is_no_chain_of_dyads_is_swept_one_by_one() -> None:
    vary = {"far": (0.28, 0.34), "arm": (0.05, 0.2)}
    wanted = traced(geared(0.31, 0.15), 8)
    fit = fit_path(geared(), wanted, vary, build=geared, seed=1, starts=1, generations=8, steps=48)
    assert fit.largest < 1e-7
    assert fit.values["far"] == pytest.approx(0.31, abs=1e-6)


def test_a_straighter_line_than_hoekens_is_found() -> None:
    """Hoeken's published proportions leave a line of length 4 by 0.0098; over the same stretch others do better."""
    published = json.loads((REFERENCE / "analytic_hoeken.json").read_text())["expected"]["over_crank_90_270deg"]
    m = four_bar(1.0, 2.3, 2.5, (2.0, 0.0), (4.5, 0.2))
    line = np.column_stack([np.linspace(4.0, 0.0, 9), np.full(9, 4.0)])
    place = {"D": ((1.5, 2.5), (-0.3, 0.3)), "P": ((4.0, 6.0), (-0.5, 0.5))}
    fit = fit_path(m, line, {"coupler": (2.0, 3.0), "rocker": (2.0, 3.0), **place}, starts=1, generations=60)
    assert fit.largest < published["dy"] / 2
    over = fit.path[(fit.path[:, 0] > 0) & (fit.path[:, 0] < 4) & (fit.path[:, 1] < 4.05)]
    assert len(over) > 100
    assert np.abs(over[:, 1] - 4.0).max() < published["dy"] / 2


def test_equal_arguments_give_equal_designs_and_the_model_is_left_alone() -> None:
    m, points = four_bar(), traced(four_bar(**KNOWN), 6)
    first, second = (fit_path(m, points, BOUNDS, seed=5, starts=1, generations=10) for _ in range(2))
    assert first.values == second.values
    np.testing.assert_array_equal(first.history, second.history)
    assert m.bodies["crank"].length == 0.1
    assert (m.traces["P"].x, m.traces["P"].y) == (0.2, 0.1)


def test_progress_is_told_and_may_end_the_fit() -> None:
    told: list[tuple[float, float]] = []

    def progress(done: float, error: float) -> None:
        told.append((done, error))
        if len(told) == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fit_path(four_bar(), traced(four_bar(**KNOWN)), BOUNDS, progress=progress)
    assert [done for done, _ in told] == sorted(done for done, _ in told)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"vary": {}}, r"vary is \{\}"),
        ({"vary": {"crank": (0.2, 0.1)}}, "'crank' may be from 0.2 to 0.1"),
        ({"vary": {"crank": "long"}}, "bounds of 'crank' are 'long'"),
        ({"vary": {"crnk": (0.1, 0.2)}}, "did you mean 'crank'"),
        ({"vary": {"crank": (-0.1, 0.2)}}, "'crank' may be from -0.1 to 0.2 m; a length is above 0"),
        ({"vary": {"crank": (False, True)}}, "bounds of 'crank'"),
        ({"vary": {"D": (0.1, 0.2)}}, "'D' is a place, so give bounds of x and of y"),
        ({"vary": {"crank": ((0.1, 0.2), (0.1, 0.2))}}, "'crank' is a length, so give one pair"),
        ({"free_start": True}, "give times=, too"),
        ({"build": 3}, "build is 3; give a function"),
        ({"build": lambda crnk=0.1: four_bar()}, "build has no argument 'crank'; it has crnk"),
        ({"build": lambda crank, rod: four_bar()}, "argument 'rod' of build neither varies nor has a default"),
        ({"build": lambda crank: 1 / 0}, "build fails: ZeroDivisionError"),
        ({"build": lambda crank: "four-bar"}, "build returned str, not a Mechanism"),
        ({"points": [(0, 0)]}, "two or more places"),
        ({"points": [(0, 0), (0, 0)]}, "same place"),
        ({"points": [(0, 0), (0, np.nan)]}, "finite"),
        ({"times": [0.0]}, "one time each"),
        ({"times": [0.1, 0.1]}, "two points have the same time"),
        ({"point": "Q"}, "no traced point 'Q'"),
        ({"least_transmission": 2.0}, "below pi/2"),
        ({"starts": 0}, "starts is 0"),
        ({"start": 1}, "four_bar: fit_path: there is no argument 'start', did you mean 'starts'"),
        ({"progress": 1}, "must be a function"),
    ],
)
def test_invalid_requests_are_refused(change: dict, says: str) -> None:
    arguments = {"points": [(0.1, 0.2), (0.2, 0.2)], "vary": {"crank": (0.05, 0.2)}} | change
    with pytest.raises(ModelError, match=says):
        fit_path(four_bar(), **arguments)


def test_objects_that_are_no_mechanism_are_refused() -> None:
    with pytest.raises(ModelError, match="fit_path: the mechanism is 3"):
        fit_path(3, [(0.1, 0.2), (0.2, 0.2)], {"crank": (0.05, 0.2)})


def test_where_nothing_closes_or_meets_the_conditions_it_says_so() -> None:
    points = [(0.1, 0.2), (0.2, 0.2)]
    with pytest.raises(SynthesisError, match="none closes over the whole motion"):
        fit_path(four_bar(), points, {"crank": (0.6, 0.7)}, starts=1, generations=2)
    with pytest.raises(SynthesisError, match=r"none of them meets a transmission angle of 1\.5 rad"):
        fit_path(four_bar(), points, {"crank": (0.05, 0.1)}, starts=1, generations=2, least_transmission=1.5)
