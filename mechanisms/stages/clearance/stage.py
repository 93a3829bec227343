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

What is proven: at every moment of the motion, which between the samples of data.json is the quintic that the film
shows, the meshes are apart by the ``proven`` gap of clearance.json. It is at most ``resolution`` below the gap that was
measured, and less what the true motion may be off between two samples there (path.py). Meshes lie within
``parts_files.TOLERANCE`` of the solids, or the ``tolerance`` of a Solid. A belt or chain is the band that it runs in
(meshing.py), compared with all but its own pulleys until an event releases it. Pieces of one body are not compared with
each other, nor are pieces of two bodies, or two pieces, that parts.json says may touch by design; clearance.json names
these pairs.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from shared.contract import Motion, Parts, Provenance, is_in_space, read_motion, read_parts
from shared.contract.clearance import Clearance, PairClearance, Proof, write_clearance
from shared.contract.quantity import counted
from shared.shapes.units import metres, mm
from shared.stage.console import Shown, say, warn
from shared.stage.errors import UserError
from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, Out
from shared.stage.scale import Scale, scale_of
from shared.stage.stages import Stage, contract_sources, key_of, versions

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechanisms.stages.clearance.path import Axes, BodyPath
    from mechanisms.stages.clearance.pieces import MeshPiece
    from mechanisms.stages.clearance.search import Least, Sweep
    from mechanisms.stages.clearance.slide import Slides

LIMIT = 0.05
"""Smaller gaps between two bodies are refused (mm)."""
REACH = 5.0
"""Larger gaps are not measured (mm)."""
REACH_OF_MODELS = 1.0
"""The same of small models, of whose pieces most are nearer to each other than that (mm)."""
LOOKS = 4
"""Moments at which is looked whether what slides stays near."""
SCHEMATIC = "`mbsd parts` says what is in the way"
"""Where to read more on parts that are shown and not built."""
PACKAGES = ("manifold3d", "numpy")
SOURCES = [
    *(ROOT / "mechanisms" / "stages" / name for name in ("clearance", "parts_files.py")),
    *contract_sources("clearance", "geometry"),
]


def run(name: str, scale: str = "") -> None:
    """Check mechanism ``name``, or its model at a scale, and write clearance.json.

    Not so if motion and parts are those of the last check.

    Raises UserError naming both pieces, the time, the depth or gap, and the remedy, if two pieces come too near.
    """
    machine, at = Out(name), scale_of(scale)
    out = Out(name, at)
    if is_in_space(machine.motion):
        say("clearance", f"{out.title}: parts of mechanisms in space are not compared yet")
        return
    parts, motion = read_parts(out.parts, out.name), read_motion(machine.motion, out.name)
    stage = _stage(out, machine, at)
    if stage.is_fresh():
        say("clearance", f"{out.title}: nothing to do")
        return
    if parts.schematic:
        raise UserError(f"{out.title}: {parts.schematic}; so there is nothing to prove. {SCHEMATIC}")
    from mechanisms.stages.clearance.path import at_scale, what_shrinks
    from mechanisms.stages.clearance.pieces import read_pieces

    reach = REACH if at is None else min(max(REACH * at.ratio, REACH_OF_MODELS), REACH)
    motion = motion if at is None else at_scale(motion, at.ratio)
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
    motion: Motion,
    pieces: list[MeshPiece],
    key: str,
    limit: float = LIMIT,
    reach: float = REACH,
    title: str = "",
) -> Clearance:
    """Check every pair of ``pieces`` of different bodies; ``limit`` and ``reach`` in mm.

    Raises as :func:`run`, with ``title`` as the name, which is that of the mechanism by default.
    """
    from mechanisms.stages.clearance import path as bodies
    from mechanisms.stages.clearance.meshing import bands, least_in_mesh, meshes
    from mechanisms.stages.clearance.outlines import least_gap
    from mechanisms.stages.clearance.path import axes_of, paths
    from mechanisms.stages.clearance.search import RESOLUTION, Sweep
    from mechanisms.stages.clearance.slide import slides_of
    from shared.contract.geometry import with_rods

    name, motion = title or parts.mechanism, with_rods(motion, parts)
    _refuse_lost(name, pieces, motion)
    where = paths(motion)
    axes, in_mesh = axes_of(motion, parts, where), meshes(motion, pieces)
    slides = slides_of(motion, where)
    home = {piece.name: piece.body for piece in pieces}
    own = {frozenset((home[name], name) for name in pair if name in home) for pair in parts.pieces_may_touch}
    """Pairs of pieces that are not compared."""
    for belt in list(bands(parts, motion, where)):
        it = belt.piece
        pieces, where[it.body] = [*pieces, it], belt.path
        axes |= {frozenset((it.body, body)): {it.body: at, body: there} for body, (at, there) in belt.axes.items()}
        own |= {frozenset(((it.body, it.name), pulley)) for pulley in belt.own}
    far = bodies.far_bodies(pieces, where, reach)
    pairs: list[PairClearance] = []
    refused: list[tuple[Sweep, Least]] = []
    apart, error = 0, 0.0
    shown = Shown("clearance", name, len(pieces) * (len(pieces) - 1) // 2, "pairs of pieces looked at")
    alike = {frozenset(pair) for pair in (*parts.may_touch, *parted_bodies(parts, motion))}
    alike |= {frozenset((piece.body,)) for piece in pieces}
    for first, second in combinations(pieces, 2):
        shown.advance()
        names = frozenset(((first.body, first.name), (second.body, second.name)))
        if frozenset((first.body, second.body)) in alike or names in own:
            continue
        height = _height_gap(first, second)
        is_far = frozenset((first.body, second.body)) in far
        if height >= reach or is_far:
            error, apart = max(error, bodies.error_of(first, second, where) if height < reach else 0.0), apart + 1
            continue
        sweep = Sweep(first, second, *bodies.common(where[first.body], where[second.body]))
        error = max(error, float(sweep.error.max(initial=0.0)))
        if sweep.is_apart(reach):
            apart += 1
            continue
        if height >= limit:
            pairs.append(_pair(first, second, height, height, None, "layers", 0))
            continue
        compared = _turn(first, second, axes, sweep, limit, reach) or _slide(first, second, slides, limit, reach)
        compared = compared or _sliced(first, second, slides, sweep, where, limit, reach)
        if compared is None:
            least = least_in_mesh(sweep, in_mesh, where) or least_gap(sweep, reach)
            if least.gap < limit or least.proven < limit / 2:
                refused.append((sweep, least))
                continue
            compared = _pair(first, second, least.gap, least.proven, least.time, "motion", least.poses)
        if min(compared.gap, compared.proven + metres(RESOLUTION)) < metres(reach):
            pairs.append(compared)
        else:
            apart += 1
    if refused:
        raise UserError(_refusal(name, refused, limit))
    return _clearance_of(parts, key, limit, error, pairs, apart)


def _clearance_of(
    parts: Parts, key: str, limit: float, error: float, pairs: list[PairClearance], apart: int
) -> Clearance:
    """Return the document; ``limit`` and ``error`` in mm."""
    from mechanisms.stages.clearance.search import RESOLUTION

    return Clearance(
        mechanism=parts.mechanism,
        provenance=Provenance(inputs=key, versions=versions(*PACKAGES)),
        limit=metres(limit),
        resolution=metres(RESOLUTION),
        interpolation_error=metres(error),
        pairs=sorted(pairs, key=lambda pair: (pair.gap, pair.pieces)),
        apart=apart,
        may_touch=parts.may_touch,
        pieces_may_touch=parts.pieces_may_touch,
    )


def parted_bodies(parts: Parts, motion: Motion) -> list[tuple[str, str]]:
    """Return pairs of bodies that an event parts by releasing a joint; their solids could not part.

    The joint is a pin, guide or rod.
    """
    released = {name: joint for name, joint in motion.joints.items() if joint.released is not None}
    rods = [(name, joint.bodies[1]) for name, joint in released.items() if name in parts.bodies]
    return rods + [joint.bodies for name, joint in released.items() if joint.pair and name not in parts.bodies]


def _parted(parts: Parts, motion: Motion) -> str:
    """Return words on the bodies that are not compared because an event parts them.

    Empty if there are none.
    """
    pairs = ", ".join(" and ".join(pair) for pair in parted_bodies(parts, motion))
    return f"; not compared, as an event parts them: {pairs}" if pairs else ""


def _refuse_lost(name: str, pieces: list[MeshPiece], motion: Motion) -> None:
    """Raise UserError for a body of parts.json that does not move in data.json."""
    lost = sorted({piece.body for piece in pieces} - {"ground"} - set(motion.bodies))
    if lost:
        raise UserError(
            f"{name}: parts.json has a body '{lost[0]}' that data.json does not move; "
            "use the names of mechanism.py in parts()"
        )


def _turn(
    first: MeshPiece, second: MeshPiece, axes: Axes, sweep: Sweep, limit: float, reach: float
) -> PairClearance | None:
    """Return the gap at every angle of a pair round the joint between its bodies.

    None if that is not enough.
    """
    from mechanisms.stages.clearance.turn import turn_gap

    axis = axes.get(frozenset((first.body, second.body)))
    if axis is None or not all(piece.is_around(axis[piece.body]) for piece in (first, second)):
        return None  # for a post beside the axis the motion shows more than all angles do
    about = [piece.triangles - [axis[piece.body][0], axis[piece.body][1], 0.0] for piece in (first, second)]
    if sweep.gap_at(float(sweep.times[0]), reach) < limit:
        return None
    gap, proven = turn_gap(about[0], about[1], reach, limit)
    if proven < limit:
        return None
    return _pair(first, second, gap, proven, None, "turn", 1)


def _slide(first: MeshPiece, second: MeshPiece, slides: Slides, limit: float, reach: float) -> PairClearance | None:
    """Return the gap at every place along the line of a prismatic joint between two bodies.

    None if that is not enough.
    """
    from mechanisms.stages.clearance.slide import slide_gap

    slid = slide_gap(first, second, slides, reach)
    if slid is None or slid[1] < limit:
        return None
    return _pair(first, second, *slid, None, "slide", 1)


def _sliced(
    first: MeshPiece,
    second: MeshPiece,
    slides: Slides,
    sweep: Sweep,
    where: Mapping[str, BodyPath],
    limit: float,
    reach: float,
) -> PairClearance | None:
    """Return the gap of a pair of which most is proven along a line and the rest by the motion.

    None if that is not enough.

    None if that is not enough. Only for a pair that stays near: else the motion alone proves it sooner.
    """
    from mechanisms.stages.clearance.outlines import least_gap
    from mechanisms.stages.clearance.search import Sweep
    from mechanisms.stages.clearance.slide import BESIDE, ROUNDING, sliced

    near = BESIDE[1] * reach
    if frozenset((first.body, second.body)) not in slides:
        return None
    if any(sweep.gap_at(float(time), near) >= near for time in sweep.times[:: max(1, len(sweep.times) // LOOKS)]):
        return None
    cut = sliced(first, second, slides, reach)
    if cut is None or cut.gap < limit:
        return None
    gap, proven, time, poses = cut.gap, min(cut.gap, cut.away) - ROUNDING, None, 1
    for mover, other in cut.rest:
        least = least_gap(Sweep(mover, other, where[mover.body], where[other.body]), reach)
        if least.gap < limit or least.proven < limit / 2:
            return None
        poses += least.poses
        proven = min(proven, least.proven)
        if least.gap < gap:
            gap, time = least.gap, least.time
    if gap > cut.away:
        return None
    return _pair(first, second, gap, proven, time, "slide" if time is None else "motion", poses)


def _height_gap(first: MeshPiece, second: MeshPiece) -> float:
    return max(first.z_range[0] - second.z_range[1], second.z_range[0] - first.z_range[1])


def _pair(
    first: MeshPiece, second: MeshPiece, gap: float, proven: float, time: float | None, proof: Proof, poses: int
) -> PairClearance:
    return PairClearance(
        bodies=(first.body, second.body),
        pieces=(first.name, second.name),
        gap=metres(gap),
        proven=metres(proven),
        time=time,
        proof=proof,
        poses=poses,
    )


def _refusal(name: str, refused: list[tuple[Sweep, Least]], limit: float) -> str:
    """Return one sentence on the worst pair, a word on the others."""
    refused = sorted(refused, key=lambda item: (-item[0].depth_at(item[1].time), item[1].gap))
    sweep, least = refused[0]
    pair = f"{sweep.mover.body}: {sweep.mover.name} and {sweep.still.body}: {sweep.still.name}"
    remedy = (
        "move one to another layer, make it smaller, or cut it out where the other passes (parts.py; there may_touch "
        "names bodies that touch by design, pieces_may_touch two pieces)"
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
