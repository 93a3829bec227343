"""Stacks of lengths: a textbook's, and what squares and sums say exactly."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binomtest, norm

from mbsd import Normal, Triangular, Uniform, tolerances
from mbsd.tolerancing.statistics import wilson

CASE = json.loads((Path(__file__).parents[1] / "published/reference/shigley_stack.json").read_text())
TOLERANCES = CASE["tolerances"]


def gap(a: float = 1.750, b: float = 0.750, c: float = 0.120, d: float = 0.875) -> float:
    return a - b - c - d


def test_the_stack_of_shigley() -> None:
    """Sleeves on a shouldered screw, example 1-3: mean and worst case of the gap, and the sleeve that leaves enough."""
    assert gap(**CASE["sizes"]) == gap()
    expected, near = CASE["expected"], CASE["tolerance"]["absolute"]
    t = tolerances(gap, TOLERANCES, n=100)
    assert t.nominal == pytest.approx(expected["w"], abs=near)
    for worst in (t.linear_worst, t.vertex_worst):
        assert worst == pytest.approx((expected["w_min"], expected["w_max"]), abs=near)
    assert sum(row.worst for row in t.rows) == pytest.approx(expected["t_w"], abs=near)

    def other(a: float = 1.750, b: float = 0.750, c: float = 0.120, d: float = expected["d_for_w_min"]) -> float:
        return gap(a, b, c, d)

    assert tolerances(other, TOLERANCES, n=100).linear_worst[0] == pytest.approx(expected["w_wanted"], abs=near)


def test_squares_of_a_linear_stack_add_up() -> None:
    t = tolerances(gap, TOLERANCES, limits=(0.003, None), n=40_000)
    exact = math.sqrt(sum(tolerance**2 for tolerance in TOLERANCES.values())) / 3
    assert t.linear_std == pytest.approx(exact, rel=1e-9)
    assert t.std == pytest.approx(exact, rel=0.02)
    assert t.mean == pytest.approx(0.005, abs=4 * exact / 200)
    assert t.shares == pytest.approx(np.array([9.0, 1.0, 25.0, 1.0]) / 36)
    assert t.yields is not None
    part = norm.sf(0.003, 0.005, exact)
    assert t.yields.low < part < t.yields.high
    assert t.yields.high - t.yields.low == pytest.approx(2 * 1.96 * math.sqrt(part * (1 - part) / 40_000), rel=0.01)
    assert t.quantile(0.5) == pytest.approx(0.005, abs=1e-4)


def test_other_distributions_have_their_own_variances() -> None:
    t = tolerances(gap, {"a": Uniform(0.003), "b": Triangular((0.0, 0.002)), "c": Normal(0.005, sigmas=2.0)}, n=40_000)
    exact = math.sqrt(0.003**2 / 3 + 0.001**2 / 6 + 0.0025**2)
    assert t.linear_std == pytest.approx(exact, rel=1e-9)
    assert t.std == pytest.approx(exact, rel=0.02)
    assert t.mean == pytest.approx(0.004, abs=1e-4)  # b lies in the middle of its tolerance
    assert t.linear_worst == pytest.approx((0.005 - 0.010, 0.005 + 0.008))


def test_halving_a_tolerance_takes_three_quarters_of_its_variance() -> None:
    t = tolerances(gap, TOLERANCES, limits=(0.0, None), n=40_000)
    squares = {name: (tolerance / 3) ** 2 for name, tolerance in TOLERANCES.items()}
    for row in t.tighten:
        left = math.sqrt(sum(squares.values()) - 0.75 * squares[row.name])
        assert row.std_halved == pytest.approx(left, rel=0.02)
        assert row.yield_halved == pytest.approx(norm.cdf(0.005 / left), abs=2e-3)
    assert [row.name for row in t.tighten][:2] == ["c", "a"]


@pytest.mark.parametrize(("good", "count"), [(0, 10), (10, 10), (81, 263), (9_990, 10_000)])
def test_the_interval_is_wilsons(good: int, count: int) -> None:
    """scipy has the same."""
    part, low, high = wilson(good, count, 0.95)
    same = binomtest(good, count).proportion_ci(0.95, method="wilson")
    assert (part, low, high) == pytest.approx((good / count, same.low, same.high), abs=1e-12)


def test_the_same_seed_gives_the_same_bytes() -> None:
    first, same, other = (tolerances(gap, TOLERANCES, n=500, seed=seed) for seed in (1, 1, 2))
    assert first.values.tobytes() == same.values.tobytes()
    assert first.values.tobytes() != other.values.tobytes()
    assert tolerances(gap, TOLERANCES, n=300, seed=1).values.tobytes() == first.values[:300].tobytes()
