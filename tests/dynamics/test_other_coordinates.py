"""Integrators and events know no coordinates: they step a body in space, whose q' is not v, as exactly as the plane.

Compared with scipy's DOP853 of Newton's and Euler's equations, and with what is conserved.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from mbsd.compiling.alternatives import alternatives
from mbsd.dynamics.formulation import add_formulation
from mbsd.dynamics.integrators.dop853.dense import interpolant
from mbsd.dynamics.integrators.kind import INTEGRATORS
from tests.dynamics.rigid_body import Flight, RigidBody, accelerate

INERTIA = np.array([0.3, 0.5, 0.7])
CORNER = np.array([0.3, -0.2, 0.4])
START = np.array([0.1, -0.2, 2.0, 0.5, 0.5, -0.5, 0.5])
"""Place and Euler parameters."""
RATES = np.array([0.5, 0.3, 1.0, 0.1, 6.0, 0.2])
"""Nearly about the middle axis, so that the body tumbles."""
TIMES = np.linspace(0.0, 2.0, 41)
GENERAL = [name for name, method in INTEGRATORS.items() if method.general]


def _rates(t: float, y: np.ndarray) -> np.ndarray:
    """(13,) rates of place, matrix-free: y = (r, e, r', w)."""
    e, v, w = y[3:7], y[7:10], y[10:13]
    x, y_, z = w
    de = 0.5 * np.array([
        -e[1] * x - e[2] * y_ - e[3] * z, e[0] * x + e[2] * z - e[3] * y_,
        e[0] * y_ + e[3] * x - e[1] * z, e[0] * z + e[1] * y_ - e[2] * x,
    ])  # fmt: skip
    return np.concatenate([v, de, [0, 0, -9.81], np.cross(INERTIA * w, w) / INERTIA])


def _reference(times: np.ndarray) -> np.ndarray:
    """(13, T)"""
    start = np.concatenate([START, RATES])
    return solve_ivp(_rates, (times[0], times[-1]), start, "DOP853", times, rtol=1e-13, atol=1e-14).y


def _matrix(q: np.ndarray) -> np.ndarray:
    """(3, 3) body to world."""
    return Rotation.from_quat(q[[4, 5, 6, 3]]).as_matrix()


def _gap(y: np.ndarray) -> float:
    return y[0, 5] + (_matrix(y[0, 3:]) @ CORNER)[2]


def _energy(y: np.ndarray) -> float:
    v, w = y[1, 3:6], y[1, 6:9]
    return float(v @ v + 0.5 * w @ (INERTIA * w) + 2.0 * 9.81 * y[0, 5])


@pytest.mark.parametrize(("name", "within"), [("dop853", 1e-9), ("radau", 1e-8), ("rk4", 1e-8)])
def test_a_tumbling_body_moves_as_by_eulers_equations(name: str, within: float) -> None:
    out = Flight(INTEGRATORS[name], INERTIA, CORNER).fly(START, RATES, TIMES)
    exact = _reference(TIMES)
    assert np.abs(out.y[:, 0, 3:] - exact[:7].T).max() < within
    assert np.abs(out.y[:, 1, 3:9] - exact[7:].T).max() < 10 * within
    assert not out.y[:, 1, 9].any()


def test_that_is_all_methods_that_say_they_can() -> None:
    assert sorted(GENERAL) == ["dop853", "radau", "rk4"]


@pytest.mark.parametrize("name", ["dop853", "radau"])
def test_a_corner_strikes_the_plane_where_it_reaches_it(name: str) -> None:
    times, states, _ = Flight(INTEGRATORS[name], INERTIA, CORNER).bounce(START, RATES, 1.5)
    assert times

    def reaches(t: float, y: np.ndarray) -> float:
        return y[2] + (_matrix(y[:7]) @ CORNER)[2]

    reaches.terminal, reaches.direction = True, -1  # type: ignore[attr-defined]
    start = np.concatenate([START, RATES])
    exact = solve_ivp(_rates, (0, 1.5), start, "DOP853", rtol=1e-13, atol=1e-14, events=reaches)
    assert times[0] == pytest.approx(exact.t[-1], abs=1e-10)
    before = exact.y[:, -1]
    arm = np.cross(CORNER, _matrix(before[:7]).T @ [0, 0, 1.0])  # Newton's law at the corner, by hand
    row = np.concatenate([[0, 0, 1.0], arm])
    given = row / np.concatenate([np.full(3, 2.0), INERTIA])
    after = before[7:] - 2.0 * (row @ before[7:]) / (row @ given) * given
    assert np.abs(states[0][1, 3:9] - after).max() < 1e-8


def test_bounces_without_loss_keep_the_energy() -> None:
    times, states, end = Flight(INTEGRATORS["dop853"], INERTIA, CORNER).bounce(START, RATES, 3.0)
    first = _energy(np.stack([np.r_[np.zeros(3), START], np.r_[np.zeros(3), RATES, 0.0]]))
    assert len(times) >= 3
    for state in states:
        assert abs(_gap(state)) < 1e-11
        assert _energy(state) == pytest.approx(first, rel=1e-9)
    assert _gap(end) > -1e-11
    assert np.linalg.norm(end[0, 6:]) == pytest.approx(1.0, abs=1e-12)


def test_a_corner_that_does_not_rebound_stays_on_the_plane() -> None:
    """A pendulum upside down: its corner slides without friction, the rest falls over, and no other corner stops it."""
    times, states, end = Flight(INTEGRATORS["dop853"], INERTIA, CORNER, restitution=0.0).bounce(START, RATES, 0.9)
    assert len(times) >= 1
    assert abs(_gap(states[0])) < 1e-11
    row = np.concatenate([[0, 0, 1.0], np.cross(CORNER, _matrix(states[0][0, 3:]).T @ [0, 0, 1.0])])
    assert abs(row @ states[0][1, 3:9]) < 1e-11
    assert np.isfinite(end).all()


def test_operations_that_are_unknown_missing_or_there_already_raise_an_error() -> None:
    class Other(RigidBody):
        pass

    with pytest.raises(TypeError, match="no operation 'speeed'"):
        add_formulation(Other, accelerate=accelerate, project=accelerate, speeed=accelerate)
    with pytest.raises(TypeError, match="'project' is missing"):
        add_formulation(Other, accelerate=accelerate)
    with pytest.raises(ValueError, match="RigidBody has a kernel here already"):
        add_formulation(RigidBody, accelerate=accelerate, project=accelerate)


def test_one_kernel_may_serve_all_other_classes() -> None:
    word = alternatives({RigidBody: "own"}, "usual")
    assert word.kernel_of(RigidBody) == "own"
    assert word.kernel_of(Flight) == "usual"


def test_code_for_an_added_class_is_kept_apart() -> None:
    """An index that names a class cannot be read by a process that lacks it."""
    Flight(INTEGRATORS["dop853"], INERTIA, CORNER).fly(START, RATES, TIMES[:3])
    folder = Path(interpolant._cache.cache_path)
    assert not [file for file in folder.glob("*.nbi") if b"rigid_body" in file.read_bytes()]
