"""Every kind of joint and driver: its J and gamma against differences of Phi along random motions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd.spatial import Mechanism
from mbsd.spatial.arrays.along import tabulated
from mbsd.spatial.arrays.packing import Packed, pack
from mbsd.spatial.model.joint import KINDS
from mbsd.spatial.model.rotation import product

STEP = 4e-3
FIRST = np.array([-1, 9, -45, 0, 45, -9, 1]) / (60 * STEP)
SECOND = np.array([2, -27, 270, -490, 270, -27, 2]) / (180 * STEP**2)
FEWEST = 23


def example(kind: str) -> Packed:
    m = Mechanism("example")
    random = np.random.default_rng(3)
    first, second = (
        m.body(
            name,
            1.0 + k,
            com=random.uniform(-0.3, 0.3, 3),
            inertia=(1.0, 1.2, 1.4, 0.1, -0.2, 0.05),
            at=random.uniform(-0.5, 0.5, 3),
            orientation=random.standard_normal(4),
        )
        for k, name in enumerate(("first", "second"))
    )
    KINDS[kind].example(m, first, second)
    return pack(m)


def flown(q: np.ndarray, v: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return coordinates (T, 3 + 7 n) of bodies that fly and turn at constant rates v (3 + 6 n,)."""
    out = np.tile(q, (len(times), 1))
    for b in range(1, (len(v) + 3) // 6):
        c, d = 7 * b - 4, 6 * b - 3
        out[:, c : c + 3] += times[:, None] * v[d : d + 3]
        w = v[d + 3 : d + 6]
        half = 0.5 * np.linalg.norm(w) * times
        turned = np.column_stack([np.cos(half), np.sin(half)[:, None] * w / np.linalg.norm(w)])
        out[:, c + 3 : c + 7] = product(turned, np.tile(q[c + 3 : c + 7], (len(times), 1)))
    return out


def test_every_kind_is_here() -> None:
    assert len(KINDS) >= FEWEST


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=12)
@given(seed=st.integers(0, 2**32 - 1))
def test_jacobian_and_gamma_are_derivatives_of_phi(kind: str, seed: int) -> None:
    packed = example(kind)
    random = np.random.default_rng(seed)
    q = np.concatenate([np.zeros(3), random.uniform(-1.0, 1.0, len(packed.design) - 3)])
    v = np.concatenate([np.zeros(3), random.uniform(-1.0, 1.0, packed.freedoms)])
    for b in range(1, len(packed.bodies)):
        e = random.standard_normal(4)
        q[7 * b - 1 : 7 * b + 3] = e / np.linalg.norm(e)
    packed.measured(q)
    turns = packed.ws.turn.copy()
    times = STEP * np.arange(-3, 4)
    poses = flown(q, v, times)
    drives = np.zeros((7, len(packed.motions) + 1, 3))
    phi, jac, gamma = tabulated(packed, drives, poses, np.tile(v, (7, 1)), np.tile(turns, (7, 1)))
    size = 1.0 + np.abs(phi).max() + np.abs(gamma).max() ** 3  # a turn is steep where the axes are nearly normal
    places = np.setdiff1d(np.arange(phi.shape[1]), packed.system.roll[:, :1] + [1, 2])  # others hold rates alone
    assert np.allclose((FIRST @ phi)[places], (jac[3] @ v[3:])[places], rtol=0, atol=1e-7 * size)
    assert np.allclose((SECOND @ phi)[places], -gamma[3][places], rtol=0, atol=1e-6 * size)
    assert np.allclose(FIRST @ (jac @ v[3:]), -gamma[3], rtol=0, atol=1e-6 * size)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_closed_in_the_design_pose(kind: str) -> None:
    packed = example(kind)
    phi, _ = packed.measured(packed.design)
    passive = packed.driver_rows
    assert np.abs(phi[:passive]).max(initial=0.0) < 1e-14


@pytest.mark.parametrize("kind", [kind for kind in KINDS if KINDS[kind].driven])
def test_laws_of_drivers_enter_phi_and_gamma(kind: str) -> None:
    packed = example(kind)
    motion = packed.design[None], np.zeros((1, packed.freedoms + 3)), np.zeros((1, len(packed.ws.turn)))
    without, law = np.zeros((1, 2, 3)), np.array([[[0.0, 0.0, 0.0], [0.3, 0.7, 1.1]]])
    phi_0, _, gamma_0 = tabulated(packed, without, *motion)
    phi, _, gamma = tabulated(packed, law, *motion)
    assert np.isclose((phi_0 - phi)[0, -1], 0.3)
    assert np.isclose((gamma - gamma_0)[0, -1], 1.1)
