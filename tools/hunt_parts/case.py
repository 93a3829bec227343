"""One case: a random mechanism, its motion, its automatic parts, and the proof that none touch."""

from __future__ import annotations

import time
import warnings
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import MechanismError
from shared.stage.errors import UserError
from tools.hunt.case import drawn
from tools.hunt.outcome import BASE, CaseResult, Outcome
from tools.hunt_parts.outcome import BUILT, COLLIDES, ERROR, REFUSED, STUCK, UNSOUND, reason
from tools.random_mechanisms import own_kinds

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.results.solution import Solution
    from mechanisms.stages.automatic.automatic import Automatic
    from mechanisms.stages.clearance.pieces import MeshPiece
    from shared.shapes.bodies import Bodies
    from tools.random_mechanisms.subject import Subject

ENGRAVED = 4
"""One case in so many has an engraved base; marks only take away, so what is clear of a bare one is clear of it."""
OWN = 10
"""One case in so many is of the kinds in own_kinds.py."""
STEPS = 360
MOST = 4.0
"""Turns of a motion that are looked at."""
OVERLAP = 2e-3
"""Part of a piece that may lie in another piece of its body: meshes of a pin in its hole."""


def run(seed: int, name: str | None = None, solids: bool = True) -> CaseResult:
    """The parts of a case; without ``solids`` as far as layers and heights."""
    began = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        kind, subject = _drawn(seed, name)
        outcome = outcome_of(subject, solids, seed % ENGRAVED == 0)
    return CaseResult(seed, kind, [outcome], time.perf_counter() - began)


def _drawn(seed: int, name: str | None) -> tuple[str, Subject]:
    """Return the mechanism of a seed, and its kind.

    Of one of :data:`OWN` seeds it is one that asks for parts in particular.
    """
    if name in own_kinds.KINDS:
        return name, own_kinds.KINDS[name].build(np.random.default_rng([seed, 72]))
    if name is None and seed % OWN == OWN // 2:
        return own_kinds.drawn(seed)
    family, subject, _ = drawn(seed, name)
    return family.name, subject


def outcome_of(subject: Subject, solids: bool = True, engraved: bool = False) -> Outcome:
    """How far the parts of a mechanism come; ``engraved``: with marks on its base."""
    try:
        solution = moved(subject)
    except MechanismError as error:
        return Outcome(BASE, STUCK, type(error).__name__, str(error))
    try:
        return parts_of(subject.m, solution, solids, engraved)
    except Exception as error:
        import traceback

        where = traceback.extract_tb(error.__traceback__)[-1]
        text = f"{type(error).__name__}: {error} ({where.filename.rpartition('/')[2]}:{where.lineno})"
        return Outcome(BASE, ERROR, type(error).__name__, text)


def moved(subject: Subject, steps: int = STEPS) -> Solution:
    """The motion, a few turns of it at most. Raises MechanismError where it cannot move so."""
    from mechanisms.stages.solve.solving import simulated_closely, swept_closely

    duration = min(subject.duration, MOST * (subject.turn or subject.duration))
    if subject.driven:
        return swept_closely(subject.m, np.linspace(0.0, duration, steps + 1))
    return simulated_closely(subject.m, duration, steps)


def parts_of(m: Mechanism, solution: Solution, solids: bool = True, engraved: bool = True) -> Outcome:
    """Plan and build the parts, with an ``engraved`` base or a bare one, and prove that none touch."""
    from mechanisms.stages.automatic.assembly import KERNEL
    from mechanisms.stages.automatic.automatic import Automatic

    made = Automatic(m, solution)
    try:
        outcome = _planned(made)
        if not solids:
            return Outcome(BASE, BUILT, _bridges(made), outcome)
        bodies = made.solids(engraved).on_stand()
    except UserError as error:
        state = UNSOUND if KERNEL in str(error) else REFUSED
        return Outcome(BASE, state, reason(str(error)), str(error))
    try:
        pieces = meshed(bodies)
    except UserError as error:
        return Outcome(BASE, UNSOUND, "not a sound solid", str(error))
    inside = overlapping(pieces)
    if inside:
        return Outcome(BASE, UNSOUND, "pieces of one body overlap", inside)
    try:
        proof = proven(m, solution, bodies, pieces)
    except UserError as error:
        if "is proven, required" in str(error):
            return Outcome(BASE, REFUSED, reason(str(error)), str(error))
        return Outcome(BASE, COLLIDES, "", str(error))
    return Outcome(BASE, BUILT, _bridges(made), f"{outcome}; {proof}")


def _planned(made: Automatic) -> str:
    """Return what is to be built, in words. Raises UserError."""
    if made.along is not None:
        made.along.refuse()
        count = len(made.along.shafts), len(made.along.cylinders), len(made.along.machine.links)
        return f"{count[0]} shafts, {count[1]} pistons, {count[2]} links, pins of {made.sizes.pin:g} mm"
    made.plan()
    return f"{max(made.levels.values(), default=-1) + 1} layers, pins of {made.sizes.pin:g} mm, {_bridges(made)}"


def _bridges(made: Automatic) -> str:
    from mechanisms.stages.automatic.pins.bridges import Bridge

    if made.along is not None:
        return "with places"
    count = sum(isinstance(feature, Bridge) for feature in made.layout.features)
    return "without bridges" if count == 0 else "with bridges"


def meshed(bodies: Bodies) -> list[MeshPiece]:
    """The pieces as the clearance stage sees them. Raises UserError for what is no sound solid."""
    from mechanisms.stages.clearance.pieces import MeshPiece
    from mechanisms.stages.parts.meshes import check_mesh, only_solid
    from mechanisms.stages.parts_files import read_mesh, read_triangles, stl_bytes
    from shared.shapes.facets import volume_of

    pieces = []
    for body, solids in bodies.items():
        for solid in solids:
            where = f"{body}: {solid.name}"
            shape = only_solid(solid.shape, where)
            stl = stl_bytes(shape, solid.tolerance)
            check_mesh(read_mesh(stl), volume_of(shape), solid.through_holes, where)
            pieces.append(MeshPiece(body, solid.name, read_triangles(stl)))
    return pieces


def overlapping(pieces: list[MeshPiece]) -> str:
    """The worst of the pairs of pieces of one body that overlap; empty if there is none."""
    worst, text = OVERLAP, ""
    boxes = [(p.triangles.min(axis=(0, 1)), p.triangles.max(axis=(0, 1))) for p in pieces]
    for (first, (low, high)), (second, (under, over)) in combinations(zip(pieces, boxes, strict=True), 2):
        if first.body != second.body or (low >= over).any() or (under >= high).any():
            continue
        inside = (first.manifold ^ second.manifold).volume()
        part = inside / min(first.manifold.volume(), second.manifold.volume())
        if part > worst:
            worst, text = part, f"{first.body}: {first.name} and {second.name} share {inside:.3g} mm^3 ({part:.1%})"
    return text


def proven(m: Mechanism, solution: Solution, bodies: Bodies, pieces: list[MeshPiece]) -> str:
    """The nearest pair. Raises UserError if two pieces of different bodies come too near."""
    from mechanisms.stages.clearance.stage import check
    from mechanisms.stages.parts.bodies import spans
    from mechanisms.stages.solve.motion_file import to_motion
    from shared.contract import BodyParts, Mass, Parts, Provenance

    nothing = Mass(mass=0.0, com=(0.0, 0.0), inertia=0.0, volume=0.0)
    parts = Parts(
        mechanism=m.name,
        provenance=Provenance(inputs="0" * 64, versions={}),
        bodies={
            body: BodyParts(
                pieces={}, mass=nothing, z=0.0, spans=spans(bodies.rods[body]) if body in bodies.rods else None
            )
            for body in bodies
        },
        may_touch=sorted(bodies.touching),
        pieces_may_touch=sorted(bodies.pieces_touching),
    )
    proof = check(parts, to_motion(solution, None, "0" * 64, {}), pieces, "0" * 64)
    if not proof.pairs:
        return f"{len(pieces)} pieces, nothing near"
    return f"{len(pieces)} pieces, nearest {1e3 * proof.pairs[0].gap:.3f} mm"
