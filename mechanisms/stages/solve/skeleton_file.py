"""The skeleton file, and the colours of bodies."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

import msgspec

from mechanisms.stages.solve.space.running import is_in_space
from shared.contract import BodyParts, Parts, Provenance
from shared.contract.materials import MATERIALS
from shared.contract.skeleton import Carried, CarriedName, Carrier, End, Moving, Name, Pose, Skeleton, Stroke

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.drawing.moving_skeleton import Moving as Drawn


# The one table of body colours: by the material of each body's main piece, or by its role where there are no parts.


def body_colours(m: Mechanism, parts: Parts | None) -> dict[str, str]:
    """Return the ink (``#rrggbb``, on light paper) of each moving body.

    Bodies of one material have shades that differ.
    """
    from mbsd.drawing.look import INKS, apart, colours_by_role

    inks = {body: INKS[word] for body, word in colours_by_role(m).items()}
    if parts is not None:
        inks |= {body: MATERIALS[main_material(parts.bodies[body])].ink for body in inks if body in parts.bodies}
    return apart(inks)


def main_material(body: BodyParts) -> str:
    """Return the material of the piece with the largest volume."""
    return max(body.pieces.values(), key=lambda piece: piece.mass.volume).material


# The mechanism with the solver's symbols, in poses over its motion, as skeleton.json has it.

POSES = 12
"""In equal times; the end of the motion is not among them, because it often is the start again."""
FINENESS = 1e-4
"""Places are rounded to this part of the symbols' size."""


def skeleton_of(solution: Solution, provenance: Provenance) -> Skeleton:
    """Return the first pose whole, with its names; of the others what is elsewhere."""
    import numpy as np

    from mbsd.drawing.strokes import moved, strokes_of

    shown = None
    if is_in_space(solution):
        from mbsd.spatial import drawing

        strokes_of, shown = cast(Any, drawing.strokes_of), drawing.moving(cast(Any, solution))
    times = np.linspace(solution.t[0], solution.t[-1], POSES + 1)[:-1]
    steps = np.unique(np.abs(solution.t[:, None] - times).argmin(axis=0))
    drawn = strokes_of(solution, [int(step) for step in steps])
    first = drawn[0]
    digits = max(0, math.ceil(-math.log10(FINENESS * first.unit)))
    poses = [Pose(time=first.time, strokes=[_stroke(stroke, digits) for stroke in first.strokes])]
    for other in drawn[1:]:
        strokes = [_stroke(stroke, digits) for stroke in moved(first, other)]
        poses.append(Pose(time=other.time, strokes=strokes))
    names = [_name(label, first.unit) for label in first.labels]
    return Skeleton(
        mechanism=solution.mechanism.name,
        provenance=provenance,
        unit=first.unit,
        names=names,
        poses=poses,
        moving=moving_of(solution, shown),
    )


def moving_of(solution: Solution, drawn: Drawn | None = None) -> Moving:
    """Return the whole skeleton for any moment; ``drawn``, if it is drawn already."""
    from mbsd.drawing.moving_skeleton import moving

    shown = moving(solution) if drawn is None else drawn
    steady = shown.steady
    digits = max(0, math.ceil(-math.log10(FINENESS * steady.unit)))
    return Moving(
        unit=steady.unit,
        low=_pair(steady.low),
        high=_pair(steady.high),
        strokes=[
            Carried(
                stroke=_stroke(stroke.stroke, digits),
                carrier=_carrier(stroke.carrier),
                shapes=[_flat(shape, digits) for shape in stroke.shapes],
            )
            for stroke in shown.strokes
        ],
        names=[CarriedName(name=_name(label, steady.unit), carrier=_carrier(by)) for label, by in shown.names],
        times=shown.times.tolist(),
    )


def _carrier(carrier: Any) -> Carrier:
    ends = [End(body=e.body, x=e.x, y=e.y, z=msgspec.UNSET if e.z is None else e.z) for e in carrier.ends]
    return Carrier(kind=carrier.kind, ends=ends)


def _name(label: Any, unit: float) -> Name:
    return Name(text=label.text, at=_pair(label.anchor), clearance=label.clearance * unit, ink=label.colour)


def _pair(place: Any) -> tuple[float, float]:
    return float(place[0]), float(place[1])


def _flat(points: Any, digits: int) -> list[float]:
    return (points.round(digits) + 0.0).ravel().tolist()  # -0 becomes 0


def _stroke(stroke: Any, digits: int) -> Stroke:
    return Stroke(
        points=_flat(stroke.points, digits),
        closed=stroke.closed,
        ink=stroke.ink,
        fill=stroke.fill,
        alpha=stroke.alpha,
        width=stroke.width,
        order=stroke.order,
        dash=list(stroke.dash),
        sign=stroke.sign,
    )
