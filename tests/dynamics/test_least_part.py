"""The smallest part of their limits with which contacts and joints hold, beside scipy's linear programmes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd.dynamics.events.laws.least_part import FORCE, MOST_PUSH, OWN, PULLED, RAW, UNIT, least_part, together_of

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
