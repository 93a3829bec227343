"""Every joint and driver, on random paths off the constraint, by central differences.

J = dPhi/dq;   J v - nu = dPhi/dt;   J a - gamma = d(J v - nu)/dt
"""

from __future__ import annotations

import importlib
import pkgutil

import numpy as np
import pytest

import mbsd.model.drivers
import mbsd.model.joints
from mbsd import Mechanism
from mbsd.arrays.packing import Packed, pack
from mbsd.compiling.jit import kernel
from mbsd.equations.assembly import evaluate_gamma, evaluate_nu, evaluate_position
from mbsd.model.joint import KINDS, JointKind, register

SEEDS = range(5)


@kernel
def _everything(system, q, v, drive, ws, nu, gamma):
    evaluate_position(system, q, drive, ws)
    evaluate_nu(system, drive, nu)
    evaluate_gamma(system, v, drive, ws, gamma)


def _example(kind: JointKind, seed: int, to_ground: bool) -> Packed:
    random = np.random.default_rng(seed)
    m = Mechanism("example")
    first = m.ground if to_ground else m.body("first", 1.0, list(random.normal(size=2)), 1.0)
    second = m.body("second", 1.0, list(random.normal(size=2)), 1.0)
    kind.example(m, first.at(*random.normal(size=3)), second.at(*random.normal(size=3)))
    return pack(m)


class _Path:
    """A smooth random motion of all coordinates, ground at rest: q(t), v(t), a(t)."""

    def __init__(self, packed: Packed, seed: int) -> None:
        n = packed.coordinates
        self.c = np.random.default_rng(seed + 100).normal(size=(4, n))
        self.packed = packed

    def at(self, t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        c0, c1, c2, c3 = self.c
        free = c0 + c1 * t + c2 * t**2 + c3 * t**3, c1 + 2 * c2 * t + 3 * c3 * t**2, 2 * c2 + 6 * c3 * t
        q, v, a = (np.concatenate([np.zeros(3), part]) for part in free)
        return q, v, a

    def terms(self, t: float, q: np.ndarray | None = None) -> tuple[np.ndarray, ...]:
        """phi, J, nu, gamma at time t, at the path's pose or at q."""
        here, v, _ = self.at(t)
        drive = self.packed.drives(np.array([t]))[0]
        rows = len(self.packed.ws.phi)
        nu, gamma = np.zeros(rows), np.zeros(rows)
        _everything(self.packed.system, here if q is None else q, v, drive, self.packed.ws, nu, gamma)
        return self.packed.ws.phi.copy(), self.packed.jacobian(), nu, gamma

    def rate(self, t: float) -> np.ndarray:
        _, v, _ = self.at(t)
        _, jac, nu, _ = self.terms(t)
        return jac @ v[3:] - nu


def all_kinds() -> list[JointKind]:
    for package in (mbsd.model.joints, mbsd.model.drivers):
        for module in pkgutil.iter_modules(package.__path__):
            importlib.import_module(f"{package.__name__}.{module.name}")
    return list(KINDS.values())


def test_each_file_registers_its_kind() -> None:
    files = {m.name for m in pkgutil.iter_modules(mbsd.model.joints.__path__)} - {"kind"}
    files |= {f"drive_{m.name}" for m in pkgutil.iter_modules(mbsd.model.drivers.__path__)}
    assert files == {kind.name for kind in all_kinds()}


@pytest.mark.parametrize("to_ground", [False, True], ids=["two_bodies", "to_ground"])
@pytest.mark.parametrize("kind", all_kinds(), ids=lambda kind: kind.name)
def test_equations_agree_with_differences(kind: JointKind, to_ground: bool) -> None:
    for seed in SEEDS:
        packed = _example(kind, seed, to_ground)
        path, t, h = _Path(packed, seed), 0.3, 1e-6
        q, v, a = path.at(t)
        _phi, jac, nu, gamma = path.terms(t)
        assert len(jac) == kind.rows
        for column in range(packed.coordinates):
            step = np.zeros_like(q)
            step[3 + column] = h
            slope = (path.terms(t, q + step)[0] - path.terms(t, q - step)[0]) / (2 * h)
            np.testing.assert_allclose(jac[:, column], slope, atol=1e-7 * max(1, np.abs(jac).max()))
        rate = (path.terms(t + h)[0] - path.terms(t - h)[0]) / (2 * h)
        np.testing.assert_allclose(jac @ v[3:] - nu, rate, atol=1e-6 * max(1, np.abs(rate).max()))
        bend = (path.rate(t + h) - path.rate(t - h)) / (2 * h)
        np.testing.assert_allclose(jac @ a[3:] - gamma, bend, atol=1e-5 * max(1, np.abs(bend).max()))


def test_a_kind_without_an_example_is_refused() -> None:
    with pytest.raises(ValueError, match="example is missing"):
        register(JointKind("bare", ("point",), example=None))  # pyright: ignore[reportArgumentType]
    with pytest.raises(ValueError, match="constraints"):
        register(JointKind("odd", ("nothing",), example=lambda m, i, j: None))
    with pytest.raises(ValueError, match="registered twice"):
        register(KINDS["revolute"])
