"""Forces of what is around the bodies: drag of air, attraction, a turning frame.

Quadratic drag of still or moving air, at a point of a body, and against turning.

    F = -c |w| w,   w = velocity of marker j less that of the air        c = rho c_d A / 2 (N s^2/m^2)
    T = -c_t |omega| omega                                               c_t (N m s^2)

The air moves with wind * gust(t). Nothing feels the opposite. Source: Batchelor, Fluid Dynamics, 1967, ch. 5.11.

Attraction of two points by a power of their distance; of masses with -2 and a = -G m_i m_j.

    F = a l^n        l = |p_j - p_i|, element LINE; negative F pulls the points together

Potential energy -a l^(n + 1) / (n + 1). Source: Newton; Goldstein, Classical Mechanics, ch. 3.

Forces of a turning frame: ground turns about a point at a rate W(t), and every body feels it.

    F = m (W^2 d - 2 W k x v - W' k x d)       at the centre of mass: centrifugal, Coriolis, Euler
    T = -I W'                                  d: centre of mass from the centre of turning, v its velocity on ground

At a constant rate the potential energy is -W^2 sum m d^2 / 2; a law of time does work instead.
Places, velocities and joints of ground are all those on the turning frame. Gravity keeps its direction there; turn it
off or write it as a law where the plane is upright. Source: Goldstein, Classical Mechanics, ch. 4.10.
"""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.base.arguments import number_pair
from mbsd.base.codes import LINE, POWER
from mbsd.model.body import Body, Marker
from mbsd.model.entries import (
    Amount,
    add_force,
    amount_given,
    amounts_given,
)
from mbsd.model.force import Element, Force, ForceKind, Interaction, Term, register_force
from mbsd.model.laws.formulas import harmonic
from mbsd.model.mechanism import Model


def _drag_interactions(force, packed):
    p = force.params
    numbers = [p["coefficient"], p["turning"], *p["wind"], p.get("gust", 0.0)]
    return (Interaction("drag", force.i, force.j, numbers, "gust" if "gust" in force.laws else None),)


DRAG = register_force(
    ForceKind(
        "drag",
        interactions=_drag_interactions,
        outside=True,
        example=lambda m, i, j: m.drag("example", j, 0.7, turning=0.2, wind=(1.0, -2.0), gust=0.5),
    )
)


@DRAG.adds
def drag(
    m: Model,
    name: str,
    at: Marker,
    coefficient: float,
    turning: float = 0.0,
    wind: Sequence[float] = (0.0, 0.0),
    gust: Amount = 1.0,
) -> Force:
    """Quadratic drag at a marker: coefficient (N s^2/m^2) times the square of its speed against the air.

    ``turning`` (N m s^2) brakes the body's turning likewise; ``body.at(*body.com)`` is its centre of mass. The air
    moves with ``wind`` (m/s, world axes) times ``gust``, a constant or a law of time.
    """
    params, laws = amount_given(m, name, "gust", gust)
    params |= amounts_given(m, name, coefficient=coefficient, turning=turning)
    params["wind"] = number_pair(f"{m.name}: force '{name}': wind", wind)
    return add_force(m, DRAG, name, m.ground.origin, at, params, laws, same_body=True)


def _elements(force):
    return (Element(LINE, (Term(POWER, force.params["factor"], 0.0, force.params["exponent"]),)),)


GRAVITATION = register_force(
    ForceKind("gravitation", _elements, sign="attraction", example=lambda m, i, j: m.gravitation("example", i, j, -2.3))
)


@GRAVITATION.adds
def gravitation(m: Model, name: str, i: Marker, j: Marker, factor: float, exponent: float = -2.0) -> Force:
    """Add a force factor * distance^exponent (N) between two points; positive pushes them apart.

    Masses attract each other with the factor -G m1 m2 and the exponent -2.
    """
    return add_force(m, GRAVITATION, name, i, j, {"factor": factor, "exponent": exponent})


def _rotating_frame_interactions(force, masses):
    law = "rate" if "rate" in force.laws else None
    return [
        Interaction(
            "rotating_frame",
            force.i,
            Marker(Body(name), *masses.com[b]),
            (masses.mass[b], masses.inertia[b], force.params.get("rate", 0.0)),
            law,
        )
        for b, name in enumerate(masses.names)
        if b > 0
    ]


def _potential(force, masses, q):
    place = q.reshape(len(q), -1, 3)[..., :2] - force.params["centre"]
    return -0.5 * force.params.get("rate", 0.0) ** 2 * (masses.mass * (place**2).sum(axis=-1)).sum(axis=-1)


ROTATING_FRAME = register_force(
    ForceKind(
        "rotating_frame",
        interactions=_rotating_frame_interactions,
        potential=_potential,
        outside=True,
        on_bodies=True,
        example=lambda m, i, j: m.rotating_frame("example", harmonic(2.0, 3.0), (0.3, -0.4)),
    )
)


@ROTATING_FRAME.adds
def rotating_frame(m: Model, name: str, rate: Amount, centre: Sequence[float] = (0.0, 0.0)) -> Force:
    """Turn ground about ``centre`` (m) at ``rate`` (rad/s, a constant or a law); all bodies feel it."""
    params, laws = amount_given(m, name, "rate", rate)
    params["centre"] = number_pair(f"{m.name}: force '{name}': centre", centre)
    middle = m.ground.at(*params["centre"])
    return add_force(m, ROTATING_FRAME, name, middle, m.ground.origin, params, laws, same_body=True)
