"""Checks of a joint, driver or contact by central differences, on random paths off the constraint.

J = dPhi/dq,   J v - nu = dPhi/dt,   J a - gamma = d(J v - nu)/dt
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from mbsd.arrays.packing import Packed, pack
from mbsd.equations.assembly import tabulate
from mbsd.mechanism import Mechanism
from mbsd.model.joint import ROWS, Joint, JointKind
from mbsd.testing.kinds import check_kept, compare, coordinate
from mbsd.testing.velocity_rows import fill_nu

SEEDS = range(5)
TIME, STEP = 0.3, 1e-6
"""Time (s) on the path, and the step of the differences (s, m, rad)."""
SLOPE, RATE, BEND = 1e-7, 1e-6, 1e-5
"""Tolerances relative to the largest number, or to 1: of J, of its product with v, of gamma."""


def check_joint(kind: JointKind, seeds: Iterable[int] = SEEDS) -> None:
    """Compare J, nu and gamma of a kind of joint, driver or contact with differences.

    Its ``example`` is added between two bodies, then between ground and a body, at random markers; both move along
    random polynomials of time. What ``adds`` decorates must keep its arguments, so that change() and files work. Raises
    AssertionError.
    """
    for seed in seeds:
        for to_ground in (False, True):
            m = example(kind, seed, to_ground)
            _check_equations(kind, _packed(m), seed)
            _check_symmetry(kind, m, seed, to_ground)
            check_kept(m)


def example(kind: JointKind, seed: int = 0, to_ground: bool = False, turn: float = 0.0) -> Mechanism:
    """Return a mechanism with a kind's example alone, between random markers and centres of mass.

    The second marker is turned by ``turn`` (rad).
    """
    random = np.random.default_rng(seed)
    m = Mechanism("example")
    first = m.ground if to_ground else m.body("first", 1.0, list(random.normal(size=2)), 1.0)
    second = m.body("second", 1.0, list(random.normal(size=2)), 1.0)
    kind.example(m, first.at(*random.normal(size=3)), second.at(*(random.normal(size=3) + np.array([0.0, 0.0, turn]))))
    made: list[Joint] = [*m.joints.values(), *m.drivers.values(), *m.contacts.values()]
    if len(made) != 1 or made[0].kind is not kind:
        raise AssertionError(f"{kind.name}: its example must add one '{kind.name}' and nothing else")
    return m


def _packed(m: Mechanism) -> Packed:
    return pack(m, list(m.contacts.values()))


def _check_equations(kind: JointKind, packed: Packed, seed: int) -> None:
    t = TIME + STEP * np.array([-1.0, 0.0, 1.0])
    q, v, a = _path(packed.coordinates, seed, t)
    phi, jac, gamma = _terms(packed, t, q, v)
    rows, n = phi.shape[1], packed.coordinates
    what = f"{kind.name}, seed {seed}"
    if rows != kind.rows:
        raise AssertionError(f"{what}: {rows} rows instead of {kind.rows}")

    def row(r: int) -> str:
        return f"row {r} ({_constraint(kind, r)})"

    steps = np.zeros((2, n, n + 3))
    steps[:, :, 3:] = STEP * np.stack([np.eye(n), -np.eye(n)])
    moved = (q[1] + steps).reshape(2 * n, n + 3)
    there = _terms(packed, np.full(2 * n, TIME), moved, np.zeros_like(moved))[0].reshape(2, n, rows)
    differences = ((there[0] - there[1]) / (2 * STEP)).T
    compare(
        f"{what}: J against dPhi/dq", jac[1], differences, SLOPE * max(1, np.abs(jac[1]).max()),
        lambda r, c: f"{row(r)}, {coordinate(packed.body_names, c + 3)}",
    )  # fmt: skip
    rate = np.einsum("krc,kc->kr", jac, v[:, 3:]) - _nu(packed, t)
    slope = (phi[2] - phi[0]) / (2 * STEP)
    compare(f"{what}: J v - nu against dPhi/dt", rate[1], slope, RATE * max(1, np.abs(slope).max()), row)
    bend = (rate[2] - rate[0]) / (2 * STEP)
    compare(
        f"{what}: J a - gamma against d(J v - nu)/dt", jac[1] @ a[1, 3:] - gamma[1], bend,
        BEND * max(1, np.abs(bend).max()), row,
    )  # fmt: skip


def _check_symmetry(kind: JointKind, m: Mechanism, seed: int, to_ground: bool) -> None:
    """Where body j has a rotational symmetry, Phi is the same after its turns."""
    if kind.symmetry is None:
        return
    [made] = [*m.joints.values(), *m.drivers.values(), *m.contacts.values()]
    order, t = kind.symmetry(made.params), np.linspace(0.0, 1.0, 20)
    plain, turned = (_packed(model) for model in (m, example(kind, seed, to_ground, math.tau / order)))
    q, v, _ = _path(plain.coordinates, seed, t)
    before, after = (_terms(packed, t, q, v)[0] for packed in (plain, turned))
    compare(
        f"{kind.name}, seed {seed}: Phi after a turn of body j by 1/{order}", after, before, SLOPE,
        lambda k, r: f"row {r} ({_constraint(kind, r)}), t = {t[k]:.3g} s",
    )  # fmt: skip


def _constraint(kind: JointKind, row: int) -> str:
    """The constraint that gives a row."""
    return [name for name in kind.constraints for _ in range(ROWS[name])][row]


def _path(n: int, seed: int, t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, v, a (T, n + 3) of a random cubic motion of all coordinates; ground rests."""
    c = np.random.default_rng(seed + 100).normal(size=(4, n))
    power = np.stack([t**0, t, t**2, t**3, 0 * t], axis=1)
    rates = np.arange(4.0)
    out = np.zeros((3, len(t), n + 3))
    out[0, :, 3:] = power[:, :4] @ c
    out[1, :, 3:] = (power[:, [4, 0, 1, 2]] * rates) @ c
    out[2, :, 3:] = (power[:, [4, 4, 0, 1]] * rates * (rates - 1.0)) @ c
    return out[0], out[1], out[2]


def _terms(packed: Packed, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Phi (T, m), J (T, m, n) and gamma (T, m) at times and states."""
    rows = len(packed.ws.phi)
    phi, gamma, compact = np.zeros((len(t), rows)), np.zeros((len(t), rows)), np.zeros((len(t), rows, 6))
    tabulate(packed.system, packed.drives(t), q, v, packed.ws, phi, compact, gamma)
    return phi, packed.spread(compact), gamma


def _nu(packed: Packed, t: np.ndarray) -> np.ndarray:
    """(T, m) velocities that the drivers impose."""
    out = np.zeros((len(t), len(packed.ws.phi)))
    for k, drive in enumerate(packed.drives(t)):
        fill_nu(packed.system, drive, out[k])
    return out
