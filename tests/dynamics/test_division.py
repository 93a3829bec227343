"""How joints at rest divide a friction that several of them could carry: by properties, beside linear programmes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag
from scipy.optimize import linprog

from mbsd.compiling.jit import kernel
from mbsd.dynamics.events.laws.complementarity import lowest_row, pivot_to_end
from mbsd.dynamics.events.laws.division import divide, division_of
from mbsd.dynamics.events.laws.least_part import FORCE, MOST_PUSH, OWN, PULLED, RAW, UNIT, least_part, together_of

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


def least_possible(case: Stuck, joints: np.ndarray, allowed: np.ndarray) -> float:
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
        parts[left] = least_possible(case, left, parts) + 1e-8
        for k in np.flatnonzero(left):
            alone = np.arange(len(left)) == k
            if least_possible(case, alone, parts) > parts[k] - 1e-4:
                left[k] = False
    return parts


@given(st.one_of(stuck(), stuck(sliding=True)), st.randoms(use_true_random=False))
def test_a_division_moves_nothing_and_no_part_is_larger_than_it_must_be(case: Stuck, random) -> None:
    out, part = case.divided()
    np.testing.assert_allclose(case.ways.T @ out, case.ways.T @ case.forces, atol=NEAR)
    assert np.abs(out / case.limits).max() == pytest.approx(part, abs=NEAR)
    assert part <= 1.0 + NEAR, "Coulomb's law allows the given division"
    assert part == pytest.approx(least_possible(case, np.ones(len(out), bool), np.zeros(len(out))), abs=1e-7)
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


MOST, LESS = 1e4, 1e-3
"""Parts above which none is looked for, and by how much less must not hold."""


def divided(
    compliance: np.ndarray, raw: np.ndarray, unit: np.ndarray, pick: np.ndarray, own: np.ndarray, held: np.ndarray
) -> tuple[np.ndarray, float]:
    """Return N and T (n,) that move nothing differently than ``raw``, and the smallest part s of their limits."""
    k, c = pick.shape
    work = together_of(c + k)
    work.compliance[...], work.held[...] = compliance, held
    work.number[RAW], work.number[UNIT], work.number[OWN, :k] = raw, unit, own
    work.pick[:k, :c] = pick
    part = float(least_part(work, c, k, 1.0))
    return work.number[FORCE].copy(), part


@dataclass
class Held:
    """Random normal forces and ways at rest, rows (r, c + k) that they keep from moving, and forces that do."""

    rows: np.ndarray
    raw: np.ndarray
    pick: np.ndarray
    own: np.ndarray

    @property
    def compliance(self) -> np.ndarray:
        """(c + k, c + k), of rank r."""
        return self.rows.T @ self.rows

    @property
    def unit(self) -> np.ndarray:
        """(c + k,)"""
        return 1.0 / np.sqrt(np.diag(self.compliance))

    def least(self) -> tuple[np.ndarray, float]:
        """What the solver finds."""
        return divided(self.compliance, self.raw, self.unit, self.pick, self.own, np.ones(len(self.raw), bool))

    def holds(self, part: float) -> bool:
        """Whether any N >= 0 and T up to this part of their limits do, N within the bound of the solver."""
        from scipy.optimize import linprog

        k, c = self.pick.shape
        g = self.compliance * self.unit * self.unit[:, None]
        scale = self.unit * np.abs(g @ (self.raw / self.unit)).max() / np.abs(g).max()
        most = MOST_PUSH * (1.0 + np.abs(self.raw[:c] / scale[:c]).sum())
        limits = [np.hstack([-part * self.pick, sign * np.eye(k)]) for sign in (1, -1)]
        push = np.append(1.0 / scale[:c], np.zeros(k))
        answer = linprog(
            np.zeros(c + k),
            A_ub=np.vstack([*limits, push]),
            b_ub=np.concatenate([part * self.own, part * self.own, [most]]),
            A_eq=self.rows,
            b_eq=self.rows @ self.raw,
            bounds=[(0, None)] * c + [(None, None)] * k,
        )
        return answer.status == 0


def random_held(seed: int) -> Held:
    """Contacts with friction and ways with limits of their own; some N >= 0 hold, the raw ones may pull."""
    random = np.random.default_rng(seed)
    c, k = int(random.integers(1, 4)), int(random.integers(1, 5))
    rows = random.normal(size=(int(random.integers(1, c + k + 1)), c + k))
    pick, own = np.zeros((k, c)), random.uniform(0.05, 1.0, k)
    for w in range(min(k, c)):
        if random.random() < 0.7:
            pick[w, w], own[w] = random.uniform(0.1, 0.8), 0.0
    holding = np.append(random.exponential(size=c) * (random.random(c) < 0.8), 0.3 * random.normal(size=k))
    free = np.linalg.svd(rows)[2][len(rows) :]
    return Held(rows, holding + free.T @ random.normal(size=len(free)), pick, own)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6))
def test_no_smaller_part_holds_and_the_forces_need_no_more(seed: int) -> None:
    held = random_held(seed)
    forces, part = held.least()
    c = held.pick.shape[1]
    if part >= MOST:
        assert not held.holds(MOST)
        return
    balance = held.rows @ held.raw
    np.testing.assert_allclose(held.rows @ forces, balance, atol=1e-9 * np.abs(balance).max())
    assert (forces[:c] >= 0.0).all()
    rounding = 1e-9 * np.abs(forces).max()
    assert (np.abs(forces[c:]) <= part * (held.pick @ forces[:c] + held.own) * (1.0 + 1e-9) + rounding).all()
    assert part < LESS or not held.holds((1.0 - LESS) * part)


def test_contacts_that_did_not_push_before_take_their_share() -> None:
    """A block on two feet, three joints: held by the first foot alone, s was 1 where 0.99958 suffice."""
    compliance = np.array(
        [
            [2.232, 1.223, -0.159, -0.159, -1.087, 5.677, -9.638],
            [1.223, 2.198, 0.482, 0.482, 0.144, 4.115, 0.620],
            [-0.159, 0.482, 0.734, 0.734, -11.73, 14.90, 0.036],
            [-0.159, 0.482, 0.734, 0.734, -11.73, 14.90, 0.036],
            [-1.087, 0.144, -11.73, -11.73, 286.7, -355.5, 74.93],
            [5.677, 4.115, 14.90, 14.90, -355.5, 451.6, -103.9],
            [-9.638, 0.620, 0.036, 0.036, 74.93, -103.9, 80.27],
        ]
    )
    raw = np.array([6.088, -0.9565, 10.06, 0.0, 0.0, 0.0, 0.0])
    pick, own = np.zeros((5, 2)), np.array([0.0, 0.0, 0.1389, 0.1192, 0.1166])
    pick[0, 0] = pick[1, 1] = 0.511
    held = np.array([True] * 3 + [False] * 4)
    unit = 1.0 / np.sqrt(np.diag(compliance))
    forces, part = divided(compliance, raw, unit, pick, own, held)
    needed = np.abs(forces[2:]) / (pick @ forces[:2] + own)
    np.testing.assert_allclose(needed, part, rtol=1e-9)


def test_what_would_have_to_pull_is_said() -> None:
    rows = np.array([[1.0, 0.0]])
    forces, part = divided(
        rows.T @ rows + 0.1 * np.eye(2),
        np.array([-1.0, 0.0]),
        np.ones(2),
        np.array([[0.3]]),
        np.zeros(1),
        np.ones(2, bool),
    )
    assert part == PULLED
    assert forces.shape == (2,)


@kernel
def pivoted(tableau, basis, n):
    """Pivot a tableau to the end; False where that has none."""
    row = lowest_row(tableau, n)
    return row < 0 or pivot_to_end(tableau, basis, n, row)


def lemke(matrix: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """Return z (n,) for M (n, n) and q (n,); None where there is none."""
    n = len(q)
    tableau = np.hstack([np.eye(n), -matrix, -np.ones((n, 1)), q[:, None]])
    basis, z = np.arange(n), np.zeros(2 * n + 1)
    if not pivoted(tableau, basis, n):
        return None
    z[basis] = tableau[:, -1]
    return z[n : 2 * n]


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 8), st.integers(1, 8), st.integers(0, 2**32 - 1))
def test_lemke_solves_what_contacts_ask(contacts: int, freedoms: int, seed: int) -> None:
    """G = A A^T, singular where contacts outnumber freedoms; g = A u, as gaps of real motions."""
    rng = np.random.default_rng(seed)
    a = rng.normal(size=(contacts, freedoms))
    g = a @ a.T
    size = np.diag(g).max()
    q = a @ rng.normal(size=freedoms)
    z = lemke(g / size, q)
    assert z is not None
    w = g / size @ z + q
    assert z.min() >= 0.0
    assert w.min() > -1e-8
    assert abs(z @ w) < 1e-7 * max(1.0, np.abs(z).max())
