"""Four-bars for the solver's tests, in closed form and as random models."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate

NAMES = ("crank", "coupler", "rocker")


@st.composite
def crank_rockers(draw: st.DrawFn) -> tuple[float, float, float, float]:
    """Return (ground, crank, coupler, rocker) of crank-rockers some way off their change points."""
    crank = draw(st.floats(0.2, 1.0))
    ground, coupler = draw(st.floats(1.2, 4.0)), draw(st.floats(1.2, 4.0))
    low, high = abs(ground - coupler) + crank, ground + coupler - crank  # rocker range of a crank-rocker
    share = draw(st.floats(0.1, 0.9))
    return ground, crank, coupler, low + share * (high - low)


def angles(lengths: tuple[float, float, float, float], phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coupler and rocker angles of the open branch at crank angles phi."""
    ground, crank, coupler, rocker = lengths
    b = crank * np.stack([np.cos(phi), np.sin(phi)], axis=1)
    diagonal = np.array([ground, 0.0]) - b
    length = np.hypot(*diagonal.T)
    bend = np.arccos((coupler**2 + length**2 - rocker**2) / (2 * coupler * length))
    theta = np.arctan2(diagonal[:, 1], diagonal[:, 0]) + bend
    c = b + coupler * np.stack([np.cos(theta), np.sin(theta)], axis=1)
    return np.unwrap(theta), np.unwrap(np.arctan2(c[:, 1], c[:, 0] - ground))


def model(
    lengths: tuple[float, float, float, float],
    speed: float = 1.0,
    masses: dict[str, tuple[float, tuple[float, float], float]] | None = None,
    turned: float = 0.0,
    gravity: tuple[float, float] | None = (0.0, -9.81),
) -> Mechanism:
    """The driven linkage on its open branch; the whole may be turned (rad)."""
    ground, crank, coupler, rocker = lengths
    m = Mechanism("random", gravity=gravity)
    bars = dict(zip(NAMES, (m.bar(n, v) for n, v in zip(NAMES, (crank, coupler, rocker), strict=True)), strict=True))
    for name, (mass, com, inertia) in (masses or {}).items():
        m.set_mass(name, mass, com, inertia)
    m.revolute("A", m.ground.at(0, 0), bars["crank"].start)
    m.revolute("B", bars["crank"].end, bars["coupler"].start)
    m.revolute("C", bars["coupler"].end, bars["rocker"].end)
    pivot = ground * math.cos(turned), ground * math.sin(turned)
    m.revolute("D", m.ground.at(*pivot), bars["rocker"].start)
    m.drive_angle("motor", bars["crank"], constant_rate(speed, turned))
    theta, swing = angles(lengths, np.zeros(1))
    degrees = [math.degrees(turned + value) for value in (0.0, float(theta[0]), float(swing[0]))]
    m.start_near(**dict(zip(NAMES, degrees, strict=True)))
    return m


@st.composite
def mass_sets(draw: st.DrawFn) -> dict[str, tuple[float, tuple[float, float], float]]:
    """Mass, offset centre of mass and inertia of each bar."""
    return {
        name: (
            draw(st.floats(0.1, 5.0)),
            (draw(st.floats(-0.5, 1.5)), draw(st.floats(-0.5, 0.5))),
            draw(st.just(0.0) | st.floats(1e-9, 2.0)),
        )
        for name in NAMES
    }
