"""Springs and dampers between two points or two bodies, bushings and shafts.

Spring and damper between two points.

    F = -k (l - l0) - c l'        l = |p_j - p_i|, element LINE

Positive F pushes the points apart; a stretched spring pulls them together. Potential energy k (l - l0)^2 / 2.
Each of k, c and l0 may be a law of time. What a law changes has no potential and does work: all of a spring with k(t),
k l0(t) of one with l0(t). Source: Haug 1989, ch. 6.2.

Torsion spring and damper between two bodies.

    T = -k (theta_j - theta_i - free) - c (omega_j - omega_i)        on body j, -T on body i; element TURN

Potential energy k (theta_j - theta_i - free)^2 / 2. Each of k, c and free may be a law of time, which does work as in
a spring between points. Source: Haug 1989, ch. 6.2.

Spring by a law of the user: any function of the distance of two points and of its rate.

    F = law(l, l')        l = |p_j - p_i|, element LINE

Positive F pushes the points apart, as in every spring: a linear one is law = -k (l - l0) - c l'. A law has no potential
energy that the program knows: all that it gives and takes is counted as work, that of an elastic part too. A function
compiled with numba.njit is compiled in. Source: Haug 1989, ch. 6.2.

Torsion spring by a law of the user: any function of two bodies' relative angle and its rate.

    T = law(theta_j - theta_i, omega_j - omega_i)        on body j, -T on body i; element TURN

A linear one is law = -k (angle - free) - c rate. As of a spring between points, all that a law gives and takes is
counted as work. Source: Haug 1989, ch. 6.2.

Bushing: springs and dampers along both axes of marker i and a torsion spring, as a rubber mount.

    F_x = -k_x x - c_x x',   F_y = -k_y y - c_y y'        x, y: place of marker j in the frame of marker i
    T   = -k_t turn - c_t turn'                           turn = theta_j - theta_i - free_angle

Elements AXIS, AXIS (turned), TURN. Source: ADAMS/Solver, BUSHING (diagonal stiffness).

Shaft that yields in torsion between two bodies about its axis, as of a rotor and its flywheel.

    T = -k (theta_j - theta_i - free) - c (omega_j - omega_i)      on body j, -T on body i; element TURN
    k = G pi (D^4 - d^4) / (32 L)                                   D: diameter, d: bore, G: shear modulus

A torsion spring by the shaft's own sizes, so that these may vary; its mass counts with the bodies. Potential energy
k (theta_j - theta_i - free)^2 / 2. Pins hold the bodies: a shaft bends in no way here. Several pieces in a row, of
bodies between them, have stiffnesses that add up as 1 / k does.

Source: Saint-Venant; Timoshenko, Strength of Materials I, ch. 10.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from mbsd.base.arguments import several_numbers
from mbsd.base.codes import AXIS, DAMPER, DAMPING, FREE, LINE, LINEAR, STIFFNESS, TURN
from mbsd.base.errors import ModelError
from mbsd.model.body import Body, Marker
from mbsd.model.entries import (
    Amount,
    above_zero,
    add_force,
    amounts_given,
    law_given,
    origins,
    spring_amounts,
)
from mbsd.model.force import Element, Force, ForceKind, Interaction, Term, register_force
from mbsd.model.mechanism import Model


def constant_terms(force: Force, free: str) -> tuple[Term, Term]:
    """Return the terms of a spring, linear or torsional, without laws; ``free`` names its free value."""
    p = force.params
    return Term(LINEAR, p.get("stiffness", 0.0), p.get(free, 0.0)), Term(DAMPING, p.get("damping", 0.0))


def terms_in_time(force: Force, free: str, turning: bool) -> tuple[Interaction, ...]:
    """One interaction for each number that is a law."""
    p = force.params
    own = {
        "stiffness": (STIFFNESS, p.get(free, 0.0)),
        "damping": (DAMPER, 0.0),
        free: (FREE, p.get("stiffness", 0.0)),
    }
    return tuple(
        Interaction("spring_in_time", force.i, force.j, [*own[name], float(turning)], name) for name in force.laws
    )


SPRING = register_force(
    ForceKind(
        "spring",
        lambda force: (Element(LINE, constant_terms(force, "free_length")),),
        interactions=lambda force, masses: terms_in_time(force, "free_length", turning=False),
        look="coil",
        example=lambda m, i, j: m.spring("example", i, j, 120.0, damping=3.0, free_length=0.4),
    )
)


@SPRING.adds
def spring(
    m: Model, name: str, i: Marker, j: Marker, stiffness: Amount, damping: Amount = 0.0, free_length: Amount = 0.0
) -> Force:
    """Spring (N/m) and damper (N s/m) between the points of two markers; ``free_length`` in m.

    Each is a constant or a law of time.
    """
    params, laws = spring_amounts(m, name, stiffness=stiffness, damping=damping, free_length=free_length)
    return add_force(m, SPRING, name, i, j, params, laws)


TORSION_SPRING = register_force(
    ForceKind(
        "torsion_spring",
        lambda force: (Element(TURN, constant_terms(force, "free_angle")),),
        interactions=lambda force, masses: terms_in_time(force, "free_angle", turning=True),
        look="spiral",
        example=lambda m, i, j: m.torsion_spring("example", i.body, j.body, 14.0, damping=0.3, free_angle=0.2),
    )
)


@TORSION_SPRING.adds
def torsion_spring(
    m: Model,
    name: str,
    first: Body | str,
    second: Body | str,
    stiffness: Amount,
    damping: Amount = 0.0,
    free_angle: Amount = 0.0,
) -> Force:
    """Add a torsion spring (N m/rad) and damper (N m s/rad) between two bodies.

    There is no torque where second - first is ``free_angle`` (rad).

    Each is a constant or a law of time.
    """
    params, laws = spring_amounts(m, name, stiffness=stiffness, damping=damping, free_angle=free_angle)
    return add_force(m, TORSION_SPRING, name, *origins(m, name, first, second), params, laws)


def law_of(force: Any, masses: Any) -> tuple[Interaction, ...]:
    """The law between points, or between bodies where the force measures an angle."""
    turning = force.kind.elements(force)[0].kind == TURN
    return (Interaction("spring_law", force.i, force.j, (float(turning),), calls_law=True),)


def _spring_law_example_law(length: Any, rate: Any) -> Any:
    return 3.0 - 2.0 * length * length - 0.4 * rate * abs(rate)


SPRING_LAW = register_force(
    ForceKind(
        "spring_law",
        lambda force: (Element(LINE, ()),),
        interactions=law_of,
        look="coil",
        example=lambda m, i, j: m.spring_law("example", i, j, _spring_law_example_law),
        saved=False,
    )
)
"""The element measures; its size comes from the interaction."""


@SPRING_LAW.adds
def spring_law(m: Model, name: str, i: Marker, j: Marker, law: Callable[[float, float], float]) -> Force:
    """Add a spring between two markers by any function ``law(length, rate)`` (m, m/s) that gives N.

    Positive pushes the points apart: ``lambda length, rate: -k * (length - free) - c * rate`` is a linear spring
    and damper. Python or compiled with numba.njit. What it gives counts as work, not as potential energy.
    """
    return add_force(m, SPRING_LAW, name, i, j, law_given(m, name, law, "the length and its rate"))


def _torsion_spring_law_example_law(angle: Any, rate: Any) -> Any:
    return 1.0 - 5.0 * angle * angle * angle - 0.3 * rate


TORSION_SPRING_LAW = register_force(
    ForceKind(
        "torsion_spring_law",
        lambda force: (Element(TURN, ()),),
        interactions=law_of,
        look="spiral",
        example=lambda m, i, j: m.torsion_spring_law("example", i.body, j.body, _torsion_spring_law_example_law),
        saved=False,
    )
)


@TORSION_SPRING_LAW.adds
def torsion_spring_law(
    m: Model, name: str, first: Body | str, second: Body | str, law: Callable[[float, float], float]
) -> Force:
    """Add a torsion spring by any function ``law(angle, rate)``, which gives the torque on ``second``.

    Units are rad, rad/s and N m.

    The angle is that of second against first: ``lambda angle, rate: -k * angle - c * rate`` is a linear one.
    """
    params = law_given(m, name, law, "the angle and its rate")
    return add_force(m, TORSION_SPRING_LAW, name, *origins(m, name, first, second), params)


def _bushing_elements(force):
    p = force.params

    def part(k: int, rest: float = 0.0) -> tuple[Term, Term]:
        return Term(LINEAR, p["stiffness"][k], rest), Term(DAMPING, p["damping"][k])

    return Element(AXIS, part(0)), Element(AXIS, part(1), turned=True), Element(TURN, part(2, p["free_angle"]))


BUSHING = register_force(
    ForceKind(
        "bushing",
        _bushing_elements,
        example=lambda m, i, j: m.bushing("example", i, j, (90.0, 140.0, 6.0), damping=(2.0, 3.0, 0.1)),
    )
)


@BUSHING.adds
def bushing(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    stiffness: Sequence[float],
    damping: Sequence[float] = (0.0, 0.0, 0.0),
    free_angle: float = 0.0,
) -> Force:
    """Springs and dampers along x and y of marker i and in turning (N/m, N/m, N m/rad), damping alike."""
    params: dict[str, Any] = {"free_angle": free_angle}
    for what, values in (("stiffness", stiffness), ("damping", damping)):
        values = several_numbers(f"{m.name}: force '{name}': {what}", values, 3, "give (x, y, turning)")
        params[what] = tuple(amounts_given(m, name, **{f"{what}[{k}]": v for k, v in enumerate(values)}).values())
    return add_force(m, BUSHING, name, i, j, params)


def _shaft_elements(force):
    p = force.params
    stiffness = p["shear_modulus"] * math.pi * (p["diameter"] ** 4 - p["bore"] ** 4) / (32.0 * p["length"])
    return (Element(TURN, (Term(LINEAR, stiffness, p["free_angle"]), Term(DAMPING, p["damping"]))),)


SHAFT = register_force(
    ForceKind(
        "shaft",
        _shaft_elements,
        example=lambda m, i, j: m.shaft(
            "example", i.body, j.body, 2.0, 0.3, shear_modulus=4e4, bore=0.1, damping=0.3, free_angle=0.2
        ),
    )
)


@SHAFT.adds
def shaft(
    m: Model,
    name: str,
    first: Body | str,
    second: Body | str,
    length: float,
    diameter: float,
    shear_modulus: float = 79.3e9,
    bore: float = 0.0,
    damping: float = 0.0,
    free_angle: float = 0.0,
) -> Force:
    """Add a shaft that twists between two bodies, by length, diameter (m) and ``shear_modulus`` (Pa).

    A ``bore`` (m) makes it hollow. ``damping`` in N m s/rad; no torque where second - first is ``free_angle`` (rad).
    The shear modulus is that of steel unless given.
    """
    params = above_zero(m, name, length=length, diameter=diameter, shear_modulus=shear_modulus)
    params |= {"free_angle": free_angle, **amounts_given(m, name, bore=bore, damping=damping)}
    if bore >= diameter:
        raise ModelError(
            f"{m.name}: force '{name}': bore is {bore:g} m in a shaft of {diameter:g} m diameter; it must be smaller"
        )
    return add_force(m, SHAFT, name, *origins(m, name, first, second), params)
