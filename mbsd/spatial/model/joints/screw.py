"""Screw: marker j turns about the z axis of marker i and moves along it, ``lead`` a turn.

    Phi = x_i . z_j;  y_i . z_j;  x_i . d;  y_i . d;  z_i . d - lead / (2 pi) turn        5 rows

The reaction on body j is a force and a moment; along the axis they do no work together.
"""

from __future__ import annotations

import math

from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import join_about
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import Row, Term, along, parallel_axes


def _rows(joint: Joint) -> list[Row]:
    i, j = joint.i, joint.j
    pitch = joint.params["lead"] / (2.0 * math.pi)
    thread = Row((Term("along", i, j, "z"), Term("turn", i, j, weight=-pitch)), "m")
    return [*parallel_axes(i, j), along(i, "x", j), along(i, "y", j), thread]


SCREW = register_joint(
    JointKind(
        "screw",
        _rows,
        example=lambda m, i, j: m.screw("example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1), lead=0.3),
        turns=True,
        slides=True,
        coupling=1,
    )
)


@SCREW.adds
def screw(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None, axis: Direction | None = None,
    *, lead: float,
) -> Joint:  # fmt: skip
    """A thread: one turn about ``axis`` moves the second body by ``lead`` (m) along it."""
    if lead == 0.0:
        raise ModelError(f"{m.name}: joint '{name}' has lead 0 m; give how far it moves in a turn, or use a revolute")
    return join_about(m, SCREW, name, first, second, at, axis, lead=lead)
