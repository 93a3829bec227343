"""Forces of a turning frame: ground turns about a point at a rate W(t), and every body feels it.

    F = m (W^2 d - 2 W k x v - W' k x d)       at the centre of mass: centrifugal, Coriolis, Euler
    T = -I W'                                  d: centre of mass from the centre of turning, v its velocity on ground

At a constant rate the potential energy is -W^2 sum m d^2 / 2; a law of time does work instead.
Places, velocities and joints of ground are all those on the turning frame. Gravity keeps its direction there; turn it
off or write it as a law where the plane is upright. Source: Goldstein, Classical Mechanics, ch. 4.10.
"""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.base.arguments import number_pair
from mbsd.model.adding.forces import (
    Amount,
    add_force,
    amount_given,
)
from mbsd.model.body import Body, Marker
from mbsd.model.force import Force, ForceKind, Interaction, register
from mbsd.model.laws.harmonic import harmonic
from mbsd.model.mechanism import Model


def _interactions(force, masses):
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


ROTATING_FRAME = register(
    ForceKind(
        "rotating_frame",
        interactions=_interactions,
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
