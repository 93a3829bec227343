"""Slides in space that shape two bodies at once: a cylinder with its rod, a ball on a plate."""

from __future__ import annotations

import numpy as np

from mbsd.spatial.model.joint import Joint
from mechanisms.stages.automatic.space import round as shapes
from mechanisms.stages.automatic.space.moves import MM
from mechanisms.stages.automatic.space.pieces import End
from mechanisms.stages.automatic.space.round import unit
from mechanisms.stages.automatic.space.surroundings import Surroundings
from shared.stage.errors import UserError

HEAD = 5.4
"""Length that a joint takes at the end of a cylinder or its rod, in rods."""
PLAY_OF_BALL = 0.08
"""Gap between a plate and a ball that runs on it (mm)."""


def is_telescope(around: Surroundings, joint: Joint) -> bool:
    """Return True if both bodies of a slide run along it, from one end each."""
    both = (joint.i, joint.j)
    return "ground" not in joint.bodies and all(
        marker.body.shape is None and len(around.others(marker)) == 1 and around.runs_along(marker) for marker in both
    )


def telescope_ends(around: Surroundings, joint: Joint) -> tuple[End, End]:
    """Return the ends of a cylinder and of its rod. Raises UserError for too long a stroke."""
    s, tube, rod = around.sizes, joint.i, joint.j
    axis = np.array(tube.axis)
    foot, head = around.others(tube)[0], around.others(rod)[0]
    seen = (around.moves.seen(tube.body.name, around.moves.world(rod.body.name, head)[:, 0]) - foot) @ axis
    way = float(np.sign(seen.mean()))
    least, most = float(np.abs(seen).min()), float(np.abs(seen).max())
    mouth, reach = least - HEAD * s.rod, least - (HEAD + 2.2) * s.rod
    if most - reach > mouth - 2.5 * s.rod:
        raise UserError(
            f"{around.moves.m.name}: the slide '{joint.name}' moves by {most - least:.4g} mm, too far for a cylinder "
            f"and a rod that fit into its shortest length, {least:.4g} mm. Make the stroke shorter, or write a "
            "parts.py"
        )
    along = way * axis
    middle, half = foot + 0.5 * (mouth + HEAD * s.rod) * along, 0.5 * (mouth - HEAD * s.rod)
    end = End(joint.name, foot + (HEAD + 0.6) * s.rod * along, [shapes.disc(middle, axis, 2.0 * s.rod, half)])
    end.cuts = [shapes.rod(foot + (HEAD + 1.2) * s.rod * along, foot + (mouth + s.rod) * along, s.rod + s.play)]
    end.lines = shapes.tube_lines(middle, axis, 2.0 * s.rod, half)
    back = float(np.sign((around.moves.place(rod) - head) @ np.array(rod.axis))) * np.array(rod.axis)
    return end, End(joint.name, head + reach * back)


def track_ends(around: Surroundings, joint: Joint) -> tuple[End | None, End]:
    """Return a plate and the ball that stays on it; None for the plate where an earlier joint of the plane has it.

    Raises UserError for a plane of ground.
    """
    s, place, axis = around.sizes, around.moves.place(joint.i), np.array(joint.i.axis)
    ball, end = around.moves.place(joint.j), End(joint.name, around.moves.place(joint.j))
    own = joint.j.body.shape
    radius = max(s.ball, 1.15 * MM * own.radius if own is not None else 0.0)
    end.adds = [shapes.ball(ball, radius, unit(around.toward(joint.j) - ball))]
    if joint.i.body.name == "ground":
        raise UserError(
            f"{around.moves.m.name}: the plane of joint '{joint.name}' is ground's, which has no automatic part in "
            "space; write a parts.py"
        )
    plane = [
        other for other in around.moves.joints()
        if other.kind.name == "point_on_plane" and other.i.body is joint.i.body
        and abs(np.array(other.i.axis) @ axis) > 1 - 1e-9
        and abs((around.moves.place(other.i) - place) @ axis) < 1e-6 * s.rod
    ]  # fmt: skip
    if joint is not plane[0]:
        return None, end
    seen = [
        around.moves.seen(joint.i.body.name, around.moves.world(other.j.body.name, around.moves.place(other.j))[:, 0])
        for other in plane
    ]
    points = np.concatenate(seen)
    side = -1.0 if (around.seen_rest(joint) - place) @ axis > 0.0 else 1.0
    below = side * (radius + PLAY_OF_BALL + s.rod)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0)) + below * axis
    for bearing in around.moves.joints():
        if {*bearing.bodies} == {joint.i.body.name, "ground"}:  # the plate stands about its shaft
            own = around.sides(bearing)[0]
            start, shaft = around.moves.place(own), np.array(own.axis)
            middle = start + (middle - start) @ axis / (shaft @ axis) * shaft
    wide = float(np.linalg.norm(points - middle, axis=1).max()) + 2.4 * s.rod
    plate = End(joint.name, middle, [shapes.disc(middle, axis, wide, s.rod)])
    plate.lines = [(middle, middle + (wide - s.rod) * ray, s.rod) for ray in shapes.rays(axis)]
    return plate, end
