"""A03, Andrews' squeezer: seven bodies in three loops, a motor and a stiff spring, 0.03 s from rest.

Data and the reference at 0.03 s: "andrews" of the Test Set for IVP Solvers (Bari), after Hairer and Wanner,
Solving Ordinary Differential Equations II, VI.9. Error: the worst of the seven angles at 0.03 s (rad).
"""

from __future__ import annotations

import math

import numpy as np

from benchmarks.dynamics.pins import GROUND, Pin, Pinned, Record, Solid, Spring

NAME = "A03 squeezer"
DURATION = 0.03
LIMITS = {"angle (rad)": 1e-5}
BAR = 50.0
"""How many times our time the best peer takes at least."""

MASSES = (0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498)
INERTIAS = (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)
A, B, C = (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)
D, DA, E, EA, RR, RA = 0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092
SS, SA, SB, SC, SD = 0.035, 0.01874, 0.01043, 0.018, 0.02
TA, TB, U, UA, UB, ZF, ZT, FA = 0.02308, 0.00916, 0.04, 0.01228, 0.00449, 0.02, 0.04, 0.01421
STIFFNESS, FREE_LENGTH, TORQUE = 4530.0, 0.07785, 0.033

# beta, Theta, gamma, Phi, delta, Omega, epsilon at the start and at 0.03 s.
START = (
    -0.0617138900142764496358948458001, 0.0, 0.455279819163070380255912382449, 0.222668390165885884674473185609,
    0.487364979543842550225598953530, -0.222668390165885884674473185609, 1.23054744454982119249735015568,
)  # fmt: skip
REFERENCE = (
    15.81077119629904, -15.75637105984298, 0.04082224013073101, -0.5347301163226948,
    0.5244099658805304, 0.5347301163226948, 1.048080741042263,
)  # fmt: skip


def _turned(angle: float, point: tuple[float, float]) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])


def model() -> Pinned:
    """Bodies K1 to K7, whose absolute angles are those named in the second line below."""
    be, th, ga, ph, de, om, ep = START
    angles = (be, be + th, ga, ph + de, de, om + ep, ep)
    o, a, b = np.zeros(2), np.array(A), np.array(B)
    f = _turned(be, (RR, 0.0))
    e = f - _turned(be + th, (D, 0.0))
    g = a + _turned(de, (ZT, 0.0))
    h = a + _turned(ep, (0.0, -U))
    bases = (o, f, b, g, a, h, a)
    centres = ((RA, 0.0), (-DA, 0.0), (SB, -SA), (0.0, EA - E), (TA, TB), (ZF - FA, 0.0), (-UB, -UA))
    poses = []
    for base, angle, centre in zip(bases, angles, centres, strict=True):
        place = base + _turned(angle, centre)
        poses.append((float(place[0]), float(place[1]), angle))
    solids = tuple(Solid(m, i, pose) for m, i, pose in zip(MASSES, INERTIAS, poses, strict=True))

    def local(body: int, point: np.ndarray) -> tuple[float, float]:
        if body == GROUND:
            return float(point[0]), float(point[1])
        x, y, angle = poses[body]
        turned = _turned(-angle, (point[0] - x, point[1] - y))
        return float(turned[0]), float(turned[1])

    meeting = (
        (GROUND, 0, o), (0, 1, f), (1, 2, e), (GROUND, 2, b), (1, 3, e),
        (3, 4, g), (GROUND, 4, a), (1, 5, e), (5, 6, h), (GROUND, 6, a),
    )  # fmt: skip
    pins = tuple(Pin(i, local(i, p), j, local(j, p)) for i, j, p in meeting)
    hook = b + _turned(ga, (SD, 0.0)) + _turned(ga, (0.0, -SC))
    spring = Spring(GROUND, C, 2, local(2, hook), STIFFNESS, FREE_LENGTH)
    return Pinned(solids, pins, torques=((0, TORQUE),), springs=(spring,))


def published(angles: np.ndarray) -> np.ndarray:
    """The reference's seven angles from the absolute angles of K1 to K7."""
    k1, k2, k3, k4, k5, k6, k7 = angles
    return np.array([k1, k2 - k1, k3, k4 - k5, k5, k6 - k7, k7])


def errors(record: Record) -> dict[str, float]:
    """By the names of LIMITS."""
    worst = float(np.abs(published(record.poses[-1, :, 2]) - np.array(REFERENCE)).max())
    if abs(record.times[-1] - DURATION) > 1e-9 or not np.isfinite(worst):
        worst = float("inf")
    return {"angle (rad)": worst}
