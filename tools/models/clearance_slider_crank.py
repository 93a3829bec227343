"""The slider-crank with a clearance joint of Flores et al., and its equations in other words.

Unknown are the rod's angle b and the slider's place x; the crank turns at a given rate. P is the rod's end, S the
slider's pin, n from P to S; the journal is the slider's, C = S + R_j n where they touch.

Source: Flores, Ambrosio, Claro, Lankarani, Koshy 2006, Mech. Mach. Theory 41, 247 (dimensions as the literature that
follows it gives them).
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

from mbsd import Mechanism, constant_rate

SPEED = 5000.0 * 2.0 * math.pi / 60.0
CRANK, ROD = 0.05, 0.12
ROD_MASS, ROD_INERTIA, SLIDER_MASS = 0.21, 2.5e-4, 0.14
RADIUS, MODULUS, POISSON = 0.01, 207e9, 0.3
TURN = 2.0 * math.pi / SPEED


def slider_crank(clearance: float | None = None, **joint) -> Mechanism:
    """At 5000 rpm from its outer dead centre; without a clearance (m) the ideal one."""
    m = Mechanism("slider_crank", gravity=None)
    crank = m.bar("crank", CRANK, mass=0.30, inertia=1e-4)
    rod = m.bar("rod", ROD, mass=ROD_MASS, inertia=ROD_INERTIA)
    slider = m.body("slider", mass=SLIDER_MASS, inertia=1e-4)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    if clearance is None:
        m.revolute("B", rod.end, slider.origin)
    else:
        given = {"modulus": MODULUS, "poisson": POISSON, "restitution": 0.9} | joint
        m.clearance_joint("B", rod.end, slider.origin, clearance, RADIUS, **given)
    m.drive_angle("motor", crank, constant_rate(SPEED))
    m.start_near(crank=0, rod=0, slider=(CRANK + ROD, 0, 0))
    return m


def reference(end: float, times: np.ndarray, clearance: float, restitution: float, friction: float, slip) -> np.ndarray:
    """(T, 4) b, x and their rates, by scipy in pieces from contact to contact."""
    journal, yielding = RADIUS - clearance, 2.0 * (1.0 - POISSON**2) / MODULUS
    stiffness = 4.0 / (3.0 * yielding) * math.sqrt(RADIUS * journal / clearance)
    hysteresis = 0.75 * (1.0 - restitution**2)
    inertia = ROD_INERTIA + ROD_MASS * (ROD / 2) ** 2

    def places(t: float, y: np.ndarray):
        turn, (b, x, db, dx) = SPEED * t, y
        a = CRANK * np.array([math.cos(turn), math.sin(turn)])
        rod = np.array([math.cos(b), math.sin(b)])
        side = np.array([-rod[1], rod[0]])
        da = CRANK * SPEED * np.array([-math.sin(turn), math.cos(turn)])
        away = np.array([x, 0.0]) - a - ROD * rod
        gone = np.array([dx, 0.0]) - da - ROD * db * side
        long = float(np.hypot(*away))
        n = away / long if long else np.zeros(2)
        return a, side, n, long, long - clearance, float(n @ gone), db, gone

    def rates(t: float, y: np.ndarray, approach: float | None) -> list[float]:
        a, side, n, long, depth, rate, db, gone = places(t, y)
        force = np.zeros(2)  # on the journal
        if approach is not None:
            normal = stiffness * math.copysign(abs(depth) ** 1.5, depth) * max(1.0 + hysteresis * rate / approach, 0.0)
            across = np.array([-n[1], n[0]])
            slip_speed = float(across @ gone) - db * (long + journal)
            share = min(max((abs(slip_speed) - slip[0]) / (slip[1] - slip[0]), 0.0), 1.0)
            force = -normal * n - friction * normal * math.copysign(share, slip_speed) * across
        arm = np.array([y[1], 0.0]) + journal * n - a
        moment = -(arm[0] * force[1] - arm[1] * force[0])
        pull = ROD_MASS * ROD / 2 * float(side @ (-(SPEED**2) * a))  # the pin A is accelerated towards O
        return [y[2], y[3], (moment - pull) / inertia, force[0] / SLIDER_MASS]

    def meets(t: float, y: np.ndarray, approach: float | None) -> float:
        return places(t, y)[4]

    y = np.array([0.0, CRANK + ROD, -CRANK * SPEED / ROD, 0.0])
    t, approach, out = 0.0, None, np.zeros((len(times), 4))
    while t < end:
        meets.terminal, meets.direction = True, 1.0 if approach is None else -1.0  # pyright: ignore[reportFunctionMemberAccess]
        part = solve_ivp(
            rates, (t, end), y, "DOP853", dense_output=True, events=meets, rtol=1e-12, atol=1e-15, args=(approach,),
            first_step=1e-9,
        )  # fmt: skip
        reached = float(part.t[-1])
        inside = (times >= t) & (times <= reached)
        out[inside] = part.sol(times[inside]).T
        t, y = reached, part.y[:, -1]
        approach = max(places(t, y)[5], 1e-3) if approach is None else None
    return out
