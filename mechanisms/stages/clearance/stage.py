"""The ``clearance`` stage: proves that no two pieces of different bodies touch over the motion.

The motion is that of data.json.

Every pair of pieces of two bodies is settled by the first of these that suffices:

1. Circles. Pieces whose circles in the plane stay apart do not meet, nor do those of bodies far apart (path.py).
2. Layers. The motion is planar, so pieces at different heights stay apart, whatever the motion.
3. Turn. Bodies with a revolute joint between them turn about one axis: the gap of pieces round it at every angle at
   once (turn.py).
   This also covers a pin in its hole with 0.1 mm of room.
4. Slide. Bodies with a prismatic joint between them slide along one line: the gap of pieces seen along it, at every
   place at once (slide.py). This covers a piston in its liner. Where slices alone are proven so, as for a
   valve in its guide, the rest is left to the motion.
5. Motion. The gap of the two meshes over the whole motion, found and proven by branch and bound: of their outlines in
   the plane (outlines.py), and where these do not suffice, of their facets (search.py). For gears, over one pitch
   of their teeth (meshing.py).

In space nothing lies in layers. A turn proves pieces round the axis of a revolute joint, as in the plane. Of others the
facets are left out that a joint keeps apart by what it keeps: distances from its centre or its axis (space/pairs.py).
The rest is searched over the motion, with bounds of the relative motion of both bodies (space/path.py); ``resolution``
is a part of the largest gap that is measured.

What is proven: at every moment of the motion, which between the samples of data.json is the quintic that the film
shows, the meshes are apart by the ``proven`` gap of clearance.json. It is at most ``resolution`` below the gap that was
measured, and less what the true motion may be off between two samples there (path.py). Meshes lie within
``parts_files.TOLERANCE`` of the solids, or the ``tolerance`` of a Solid. A belt or chain is the band that it runs in
(meshing.py), compared with all but its own pulleys until an event releases it. Pieces of one body are not compared with
each other, nor are pieces of two bodies, or two pieces, that parts.json says may touch by design; clearance.json names
these pairs.
"""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

from shared.contract import AnyMotion, Motion, Parts, Provenance, read_any_motion, read_parts
from shared.contract.clearance import Clearance, PairClearance, write_clearance
from shared.contract.quantity import counted
from shared.shapes.units import metres, mm
from shared.stage.console import Shown, say, warn
from shared.stage.errors import UserError
from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, Out
from shared.stage.scale import Scale, scale_of
from shared.stage.stages import Stage, contract_sources, key_of, versions

if TYPE_CHECKING:
    from mechanisms.stages.clearance.pairs import Pairs, Refused
    from mechanisms.stages.clearance.pieces import MeshPiece
    from mechanisms.stages.clearance.search import Least, Sweep

LIMIT = 0.05
"""Smaller gaps between two bodies are refused (mm)."""
REACH = 5.0
"""Larger gaps are not measured (mm)."""
REACH_OF_MODELS = 1.0
"""The same of small models, of whose pieces most are nearer to each other than that (mm)."""
SCHEMATIC = "`mbsd parts` says what is in the way"
"""Where to read more on parts that are shown and not built."""
PACKAGES = ("manifold3d", "numpy")
SOURCES = [
    *(ROOT / "mechanisms" / "stages" / name for name in ("clearance", "parts_files.py")),
    *contract_sources("clearance", "geometry", "links", "quaternions"),
]


def run(name: str, scale: str = "") -> None:
    """Check mechanism ``name``, or its model at a scale, and write clearance.json.

    Not so if motion and parts are those of the last check.

    Raises UserError naming both pieces, the time, the depth or gap, and the remedy, if two pieces come too near.
    """
    machine, at = Out(name), scale_of(scale)
    out = Out(name, at)
    parts, motion = read_parts(out.parts, out.name), read_any_motion(machine.motion, out.name)
    stage = _stage(out, machine, at)
    if stage.is_fresh():
        say("clearance", f"{out.title}: nothing to do")
        return
    if parts.schematic:
        raise UserError(f"{out.title}: {parts.schematic}; so there is nothing to prove. {SCHEMATIC}")
    from mechanisms.stages.clearance.path import at_scale, what_shrinks
    from mechanisms.stages.clearance.pieces import read_pieces

    reach = REACH if at is None else min(max(REACH * at.ratio, REACH_OF_MODELS), REACH)
    if at is not None and not isinstance(motion, Motion):
        raise UserError(f"{out.title}: there are no models at a scale of mechanisms in space yet; leave --scale out")
    motion = at_scale(motion, at.ratio) if at is not None and isinstance(motion, Motion) else motion
    pieces = read_pieces(parts, out.parts_folder)
    try:
        checked = check(parts, motion, pieces, stage.key, reach=reach, title=out.title)
    except UserError as error:
        if at is None or at.ratio >= 1:
            raise
        raise UserError(f"{error}; {what_shrinks(at)}") from error
    write_clearance(out.clearance, checked)
    stage.record()
    say("clearance", _summary(checked, out.title) + _parted(parts, motion))


def run_or_warn(name: str) -> None:
    """Run the stage for what goes on anyway, as pictures: parts that are shown and not built are reported.

    Raises as :func:`run` for all others.
    """
    out = Out(name)
    try:
        run(name)
    except UserError as error:
        if not read_parts(out.parts, out.name).schematic:
            raise
        warn("clearance", str(error))


def is_fresh(name: str) -> bool:
    """Return True if there is nothing to do. Raises OSError where parts or motion are missing."""
    return _stage(Out(name), Out(name)).is_fresh()


def _stage(out: Out, machine: Out, scale: Scale | None = None) -> Stage:
    """Return the stage of the model in ``out``, which moves as its machine does."""
    scaled = [] if scale is None else [str(scale)]
    key = key_of(out.parts, machine.motion, sources_hash(*SOURCES), versions(*PACKAGES), LIMIT, REACH, *scaled)
    return Stage(out, "clearance", key, [out.clearance])


def check(
    parts: Parts,
    motion: AnyMotion,
    pieces: list[MeshPiece],
    key: str,
    limit: float = LIMIT,
    reach: float = REACH,
    title: str = "",
) -> Clearance:
    """Check every pair of ``pieces`` of different bodies; ``limit`` and ``reach`` in mm.

    Raises as :func:`run`, with ``title`` as the name, which is that of the mechanism by default.
    """
    compare = _pairs(parts, motion, pieces, limit, reach)
    name = title or parts.mechanism
    pairs: list[PairClearance] = []
    refused: list[Refused] = []
    apart = 0
    shown = Shown("clearance", name, math.comb(len(compare.pieces), 2), "pairs of pieces looked at")
    alike = {frozenset(pair) for pair in (*parts.may_touch, *parted_bodies(parts, motion))}
    alike |= {frozenset((piece.body,)) for piece in compare.pieces}
    for first, second in combinations(compare.pieces, 2):
        shown.advance()
        names = frozenset(((first.body, first.name), (second.body, second.name)))
        if frozenset((first.body, second.body)) in alike or names in compare.exempt:
            continue
        outcome = compare.compared(first, second)
        if outcome is None:
            apart += 1
        elif isinstance(outcome, PairClearance):
            pairs.append(outcome)
        else:
            refused.append(outcome)
    if refused:
        raise UserError(_refusal(name, [(pair.sweep, pair.least) for pair in refused], limit, motion))
    return _clearance_of(parts, key, limit, compare, pairs, apart)


def _pairs(parts: Parts, motion: AnyMotion, pieces: list[MeshPiece], limit: float, reach: float) -> Pairs:
    """Return what compares pieces in the plane or in space.

    Raises UserError for a body of parts.json that does not move in data.json.
    """
    from mechanisms.stages.clearance.pairs import PlanePairs
    from mechanisms.stages.clearance.space.pairs import SpacePairs

    moving = {*motion.bodies, *(name for name, body in parts.bodies.items() if body.spans or body.link)}
    lost = sorted({piece.body for piece in pieces} - {"ground"} - moving)
    if lost:
        raise UserError(
            f"{parts.mechanism}: parts.json has a body '{lost[0]}' that data.json does not move; "
            "use the names of mechanism.py in parts()"
        )
    if isinstance(motion, Motion):
        return PlanePairs(parts, motion, pieces, limit, reach)
    return SpacePairs(parts, motion, pieces, limit, reach)


def _clearance_of(
    parts: Parts, key: str, limit: float, compare: Pairs, pairs: list[PairClearance], apart: int
) -> Clearance:
    """Return the document; ``limit`` in mm."""
    return Clearance(
        mechanism=parts.mechanism,
        provenance=Provenance(inputs=key, versions=versions(*PACKAGES)),
        limit=metres(limit),
        resolution=metres(compare.resolution),
        interpolation_error=metres(compare.error),
        pairs=sorted(pairs, key=lambda pair: (pair.gap, pair.pieces)),
        apart=apart,
        may_touch=parts.may_touch,
        pieces_may_touch=parts.pieces_may_touch,
    )


def parted_bodies(parts: Parts, motion: AnyMotion) -> list[tuple[str, str]]:
    """Return pairs of bodies that an event parts by releasing a joint; their solids could not part.

    The joint is a pin, guide or rod.
    """
    if not isinstance(motion, Motion):
        return []
    released = {name: joint for name, joint in motion.joints.items() if joint.released is not None}
    rods = [(name, joint.bodies[1]) for name, joint in released.items() if name in parts.bodies]
    return rods + [joint.bodies for name, joint in released.items() if joint.pair and name not in parts.bodies]


def _parted(parts: Parts, motion: AnyMotion) -> str:
    """Return words on the bodies that are not compared because an event parts them.

    Empty if there are none.
    """
    pairs = ", ".join(" and ".join(pair) for pair in parted_bodies(parts, motion))
    return f"; not compared, as an event parts them: {pairs}" if pairs else ""


def _refusal(name: str, refused: list[tuple[Sweep, Least]], limit: float, motion: AnyMotion) -> str:
    """Return one sentence on the worst pair, a word on the others."""
    refused = sorted(refused, key=lambda item: (-item[0].depth_at(item[1].time), item[1].gap))
    sweep, least = refused[0]
    pair = f"{sweep.mover.body}: {sweep.mover.name} and {sweep.still.body}: {sweep.still.name}"
    remedy = (
        f"move one {'to another layer' if isinstance(motion, Motion) else 'aside'}, make it smaller, or cut it out "
        "where the other passes (parts.py; there may_touch names bodies that touch by design, pieces_may_touch two "
        "pieces)"
    )
    if least.gap >= limit and least.given_up and least.gap - least.error >= limit:
        text = (
            f"{name}: {pair} come as near as {least.gap:.3g} mm where they were measured. The search for a nearer "
            f"pose was given up: their {len(sweep.mover.triangles)} and {len(sweep.still.triangles)} facets run too "
            f"long beside each other. No more than {least.proven:.3g} mm is proven, required {limit / 2:g} mm. Use "
            "fewer facets (a larger tolerance of the Solid in parts.py), more room between the two, or a shorter "
            "motion; more steps do not help"
        )
    elif least.gap >= limit:
        text = (
            f"{name}: {pair} come as near as {least.gap:.3g} mm, and between two samples of data.json they may be "
            f"{least.error:.3g} mm off. No more than {least.proven:.3g} mm is proven, required {limit / 2:g} mm. Solve "
            "with more steps, or with event_rows=True if there are impacts. Without STEPS and motion() steps are added "
            "where it is fast"
        )
    elif (overlap := sweep.overlap(least.time)).depth > 0:
        text = (
            f"{name}: {pair} collide: deepest at t={overlap.time:.4g} s by {overlap.depth:.3g} mm, "
            f"touching between t={overlap.first:.4g} s and t={overlap.last:.4g} s; {remedy}"
        )
    else:
        near = f"as near as {least.gap:.3g} mm at t={least.time:.4g} s"
        text = f"{name}: {pair} come {near}, required {limit:g} mm; {remedy}"
    others = [f"{s.mover.name} and {s.still.name}" for s, _ in refused[1:]]
    if others:
        more = f" and {len(others) - 5} more" if len(others) > 5 else ""
        text += f". Also too near: {', '.join(others[:5])}{more}"
    return text


def _summary(clearance: Clearance, title: str) -> str:
    count = len(clearance.pairs) + clearance.apart
    text = f"{title}: {counted(count, 'pair')} of pieces, none touch"
    if clearance.pairs:
        nearest = clearance.pairs[0]
        when = "at every angle" if nearest.time is None else f"at t={nearest.time:.3g} s"
        text += f"; nearest {nearest.pieces[0]} and {nearest.pieces[1]}: {mm(nearest.gap):.3f} mm {when}"
    touching = [*clearance.may_touch, *clearance.pieces_may_touch]
    if touching:
        text += f"; not compared, as they may touch: {', '.join(' and '.join(pair) for pair in touching)}"
    return text
