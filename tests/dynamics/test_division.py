"""How joints at rest divide a friction that several of them could carry: by properties, beside linear programmes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag
from scipy.optimize import linprog

from mbsd.dynamics.events.laws.division import divide, division_of

NEAR = 1e-8


class Stuck:
    """Joints at rest: how their forces (n,) load freedoms, by ``ways`` (n, f), and their limits (n,).

    Their rates by those of freedoms are ``rates`` (n, f), which are ``ways`` but where contacts slide.
    """

    def __init__(
        self,
        ways: np.ndarray,
        mobility: np.ndarray,
        forces: np.ndarray,
        limits: np.ndarray,
        rates: np.ndarray | None = None,
    ) -> None:
        self.ways, self.mobility, self.forces, self.limits = ways, mobility, forces, limits
        self.compliance = np.ascontiguousarray((ways if rates is None else rates) @ mobility @ ways.T)

    def divided(self, order: np.ndarray | None = None) -> tuple[np.ndarray, float]:
        """Forces (n,) and s, with the joints in this order."""
        n = len(self.forces)
        order = np.arange(n) if order is None else order
        out = self.forces[order]
        compliance = np.ascontiguousarray(self.compliance[np.ix_(order, order)])
        part = divide(compliance, np.ones(n, np.int64), out, self.limits[order], division_of(n))
        back = np.empty(n)
        back[order] = out
        return back, part


@st.composite
def stuck(draw: st.DrawFn, sliding: bool = False) -> Stuck:
    """Two to eight joints with one to three freedoms, some of whose rates are whole numbers, as in parallelograms."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    n, freedoms = draw(st.integers(2, 8)), draw(st.integers(1, 3))
    ways = np.round(rng.uniform(-2.0, 2.0, (n, freedoms)), 1)
    if draw(st.booleans()):
        ways = np.rint(ways)
    ways[~ways.any(axis=1), 0] = 1.0
    skew = rng.uniform(-0.4, 0.4, (freedoms, freedoms))
    limits = rng.uniform(0.1, 3.0, n) if draw(st.booleans()) else np.ones(n)
    mobility = np.eye(freedoms) + skew @ skew.T
    if not sliding:
        return Stuck(ways, mobility, rng.uniform(-1.0, 1.0, n) * limits, limits)
    mobility += 3.0 * (skew - skew.T)
    rates = ways + rng.uniform(-1.0, 1.0, ways.shape)
    backwards = ((rates @ mobility) * ways).sum(axis=1) < 0.1
    rates[backwards] = ways[backwards]
    return Stuck(ways, mobility, rng.uniform(-1.0, 1.0, n) * limits, limits, rates)


def least_part(case: Stuck, joints: np.ndarray, allowed: np.ndarray) -> float:
    """The smallest largest part of ``joints`` (n,) that the loads let them have, by a linear programme.

    The others may have the parts that are ``allowed`` (n,).
    """
    bounded = np.where(joints, 0.0, np.minimum(allowed, 1e6)) * case.limits
    rows = np.c_[np.eye(len(joints)), np.where(joints, -case.limits, 0.0)]
    balance = np.c_[case.ways.T, np.zeros(case.ways.shape[1])]
    least = linprog(
        np.r_[np.zeros(len(joints)), 1.0],
        np.vstack([rows, rows * np.r_[-np.ones(len(joints)), 1.0]]),
        np.r_[bounded, bounded],
        balance,
        case.ways.T @ case.forces,
        [(None, None)] * len(joints) + [(0.0, None)],
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    return float(least.fun)


def smallest_parts(case: Stuck) -> np.ndarray:
    """(n,) parts of which the largest is as small as possible, then the second largest, and so on."""
    left, parts = np.ones(len(case.forces), bool), np.full(len(case.forces), np.inf)
    while left.any():
        parts[left] = least_part(case, left, parts) + 1e-8
        for k in np.flatnonzero(left):
            alone = np.arange(len(left)) == k
            if least_part(case, alone, parts) > parts[k] - 1e-4:
                left[k] = False
    return parts


@given(st.one_of(stuck(), stuck(sliding=True)), st.randoms(use_true_random=False))
def test_a_division_moves_nothing_and_no_part_is_larger_than_it_must_be(case: Stuck, random) -> None:
    out, part = case.divided()
    np.testing.assert_allclose(case.ways.T @ out, case.ways.T @ case.forces, atol=NEAR)
    assert np.abs(out / case.limits).max() == pytest.approx(part, abs=NEAR)
    assert part <= 1.0 + NEAR, "Coulomb's law allows the given division"
    assert part == pytest.approx(least_part(case, np.ones(len(out), bool), np.zeros(len(out))), abs=1e-7)
    order = np.array(random.sample(range(len(out)), len(out)))
    np.testing.assert_allclose(case.divided(order)[0], out, atol=NEAR)


def test_joints_that_move_each_other_more_than_themselves_divide_too() -> None:
    """Beside joint 0 the others move by each other alone: no pivot is left on the diagonal of their compliance."""
    compliance = np.ones((4, 4))
    compliance[1, 2:] += 2.0
    compliance[2:, 1] -= 2.0
    forces = np.array([3.0, 1.0, 2.0, 0.0])
    out = forces.copy()
    part = divide(compliance, np.ones(4, np.int64), out, np.ones(4), division_of(4))
    np.testing.assert_allclose(out, [3.0, 1.0, 1.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(compliance @ out, compliance @ forces, atol=1e-14)
    assert part == 3.0


@given(stuck(), st.integers(0, 7))
def test_a_joint_counted_the_other_way_only_changes_its_sign(case: Stuck, joint: int) -> None:
    sign = np.ones(len(case.forces))
    sign[joint % len(sign)] = -1.0
    other = Stuck(case.ways * sign[:, None], case.mobility, case.forces * sign, case.limits)
    np.testing.assert_allclose(other.divided()[0] * sign, case.divided()[0], atol=NEAR)


@given(stuck(), st.integers(0, 2**32 - 1))
def test_a_division_changes_by_little_where_loads_and_limits_do(case: Stuck, seed: int) -> None:
    rng, n = np.random.default_rng(seed), len(case.forces)
    forces, limits = case.forces + 1e-10 * rng.uniform(-1, 1, n), case.limits * (1.0 + 1e-10 * rng.uniform(-1, 1, n))
    near = Stuck(case.ways, case.mobility, forces, limits)
    np.testing.assert_allclose(near.divided()[0], case.divided()[0], atol=1e-6)


@given(stuck(), stuck(), st.booleans())
def test_what_moves_nothing_of_another_shares_nothing_with_it(first: Stuck, second: Stuck, heavy: bool) -> None:
    """Also where one stands on the other, so that their masses couple them."""
    mobility = block_diag(first.mobility, second.mobility)
    if heavy:
        mobility[: len(first.mobility), len(first.mobility) :] = 0.2
        mobility = mobility @ mobility.T
    together = Stuck(
        block_diag(first.ways, second.ways),
        mobility,
        np.r_[first.forces, second.forces],
        np.r_[first.limits, second.limits],
    )
    out, part = together.divided()
    alone = [first.divided(), second.divided()]
    np.testing.assert_allclose(out, np.concatenate([own for own, _ in alone]), atol=NEAR)
    assert part == pytest.approx(max(own for _, own in alone), abs=NEAR)


@pytest.mark.slow
@settings(max_examples=300)
@given(stuck())
def test_the_next_largest_parts_are_as_small_as_possible_too(case: Stuck) -> None:
    np.testing.assert_allclose(np.abs(case.divided()[0] / case.limits), smallest_parts(case), atol=1e-3)


def test_the_second_of_two_freedoms_in_closed_form() -> None:
    """Joints 0 and 1 turn with the first freedom, 2 and 3 with the second, 4 with both."""
    ways = np.array([[1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [0.0, -1.0], [1.0, 1.0]])
    forces = np.array([6.0, 0.0, 1.0, 0.0, 0.0])
    case = Stuck(ways, np.eye(2), forces, np.ones(5))
    # the first freedom alone: 1 + 2 + 1 carry 6, each a part of 1.5; 1 - 1.5 = -0.5 is left to 2 and 3
    np.testing.assert_allclose(case.divided()[0], [1.5, 1.5, -0.25, 0.25, 1.5], atol=1e-15)
    assert case.divided()[1] == 1.5


def test_joints_without_load_carry_nothing_and_joints_without_limit_hold_nothing() -> None:
    ways = np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]])
    free = Stuck(ways, np.eye(2), np.array([1.0, -1.0, 2.0, 0.0]), np.ones(4))
    np.testing.assert_allclose(free.divided()[0], [0.0, 0.0, 1.0, 1.0], atol=1e-15)
    none = Stuck(ways, np.eye(2), np.array([1.0, 0.0, 2.0, 0.0]), np.array([0.0, 0.0, 4.0, 4.0]))
    out, part = none.divided()
    np.testing.assert_allclose(out, [0.5, 0.5, 1.0, 1.0], atol=1e-12)
    assert part > 1e6
    nothing = Stuck(ways, np.eye(2), np.zeros(4), np.zeros(4))
    np.testing.assert_array_equal(nothing.divided()[0], 0.0)
    assert nothing.divided()[1] == 0.0
