"""Parts in space that would meet: round parts of two bodies, looked at as lines with radii at poses of the motion."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from mechanisms.stages.automatic.space.ends import Line, Stand
from mechanisms.stages.automatic.space.moves import Array, Moves
from shared.stage.errors import UserError

DEEP = 0.5
"""Depth from which on two parts meet, in rods: lines have round ends where parts end flat."""
NEAR = 5.5
"""Distance from a joint of both bodies within which parts belong to it, in rods."""
POINTS = 9
"""Points of a line that are compared with the lines of other bodies."""


def refuse_meeting(moves: Moves, lines: dict[str, list[Line]], stands: list[Stand], joined: dict[str, str]) -> None:
    """Raise UserError for two bodies whose parts meet; ``joined`` has the joint of each massless link."""
    whole = lines | {"ground": [(stand.place, stand.place, stand.reach) for stand in stands]}
    clouds = {body: _cloud(moves, body, own) for body, own in whole.items() if own}
    for first_body, other in combinations(clouds, 2):
        joints = _common(moves, first_body, other, joined)
        row, depth = _deepest(clouds[first_body], clouds[other], joints, moves.sizes.rod)
        if depth > DEEP * moves.sizes.rod:
            time = float(moves.solution.t[moves.rows[row]])
            raise UserError(
                f"{moves.m.name}: parts of '{first_body}' and '{other}' would meet at t = {time:.4g} s, by "
                f"{depth:.1f} mm: "
                "straight rods do not go round each other. Change lengths or the range of the motion, or write a "
                "parts.py"
            )


def _cloud(moves: Moves, body: str, own: list[Line]) -> tuple[Array, Array]:
    """Return points (T, n, 3) on the lines of a body, and the radii (n,) about them."""
    part = np.linspace(0.0, 1.0, POINTS)[:, None]
    points = np.concatenate([a + part * (b - a) if np.any(a != b) else a[None] for a, b, _ in own])
    radii = np.concatenate([np.full(POINTS if np.any(a != b) else 1, radius) for a, b, radius in own])
    return moves.world(body, points), radii


def _common(moves: Moves, first_body: str, other: str, joined: dict[str, str]) -> list[Array]:
    """Return the places (T, 3) over the motion of the joints that two bodies have in common."""
    out = []
    for joint in moves.joints():
        links = {name for name, of in joined.items() if of == joint.name}
        if {first_body, other} <= {*joint.bodies, *links}:
            out += [moves.world(marker.body.name, moves.place(marker))[:, 0] for marker in (joint.i, joint.j)]
    return out


def _deepest(
    first: tuple[Array, Array], second: tuple[Array, Array], joints: list[Array], rod: float
) -> tuple[int, float]:
    """Return the pose at which two clouds are deepest in each other, and how deep (mm)."""
    (a, of_a), (b, of_b) = first, second
    worst = 0, -np.inf
    for row in range(len(a)):
        near, by = a[row], of_a
        for place in joints:
            kept = np.linalg.norm(near - place[row], axis=1) > NEAR * rod
            near, by = near[kept], by[kept]
        if len(near):
            gap = np.linalg.norm(near[:, None] - b[row], axis=2) - by[:, None] - of_b
            worst = max(worst, (row, -float(gap.min())), key=lambda depth: depth[1])
    return worst
