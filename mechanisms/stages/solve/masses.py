"""Masses for a motion: from mechanism.py, from parts.json, or estimated; and motions without masses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any, Literal

from mechanisms.stages.solve import solving
from mechanisms.stages.solve.space.running import give_masses_of_parts, is_in_space, lacks_mass
from shared.contract import BodyParts, Mass, Parts
from shared.contract.materials import MATERIALS
from shared.contract.quantity import written
from shared.stage.console import say
from shared.stage.errors import UserError, did_you_mean

if TYPE_CHECKING:
    from mbsd import Marker, Mechanism, Solution


# Masses for a motion: from mechanism.py, from parts.json, or estimated.

# Estimates masses of bodies that have none yet: each counts as a uniform aluminium plate through its markers.
#
#     outline       convex hull of discs of radius r about the markers: a disc, a bar with round ends, or a plate
#     r             the wheel's radius where a joint rolls there; else 0.06 L; 0.12 L where there is one marker alone
#     thickness h   0.05 L;  L: the largest distance between two markers of one body, ground included
#     mass          rho h A;  centre of mass and second moments of the polygon by Green's theorem
#
# A 120 mm linkage gets bars of 14 x 6 mm, about what its parts become.

HALF_WIDTH, THICKNESS = 0.06, 0.05
"""Half width and thickness of a bar, as parts of L."""
LEAST_SIZE = 0.1
"""L (m) where no body has two markers apart."""
CORNERS = 96
"""Corners of the polygon that stands for a disc."""


@dataclass(frozen=True)
class Estimate:
    """kg, centre of mass (m, body frame), inertia about it (kg m^2)."""

    mass: float
    com: tuple[float, float]
    inertia: float


def estimated_masses(m: Mechanism) -> dict[str, Estimate]:
    """Return the estimated mass of each moving body, by name, whatever mass it has."""
    discs: dict[str, list[tuple[float, float, float]]] = {name: [] for name in m.bodies}
    for marker, radius in _discs(m):
        discs[marker.body.name].append((marker.x, marker.y, radius))
    for name, body in m.bodies.items():
        if body.length is not None:
            discs[name] += [(0.0, 0.0, 0.0), (body.length, 0.0, 0.0)]
    size = max((_extent(disc) for disc in discs.values()), default=0.0) or LEAST_SIZE
    return {name: _plate(disc, size) for name, disc in discs.items() if name != "ground"}


def _discs(m: Mechanism) -> Iterator[tuple[Marker, float]]:
    """Yield every marker that is used, with the radius of the wheel about it (m), or 0."""
    from mbsd.model.force import ForceKind
    from mbsd.model.teeth import with_radii

    for joint in chain(m.joints.values(), m.drivers.values(), m.contacts.values(), m.forces.values()):
        params = with_radii(joint.params)
        rolls = not isinstance(joint.kind, ForceKind) or joint.kind.surface is not None
        wheel = params.get("radius", 0.0) if rolls and "slots" not in params else 0.0
        yield joint.i, float(params.get("radius_i", 0.0))
        yield joint.j, float(params.get("radius_j", wheel))
    for marker in m.traces.values():
        yield marker, 0.0


def _extent(discs: list[tuple[float, float, float]]) -> float:
    import numpy as np

    places = np.array([disc[:2] for disc in discs]).reshape(-1, 2)
    if not len(places):
        return 0.0
    return float(np.hypot(*(places[:, None] - places).transpose(2, 0, 1)).max())


def _plate(discs: list[tuple[float, float, float]], size: float) -> Estimate:
    import numpy as np
    from scipy.spatial import ConvexHull

    places = discs or [(0.0, 0.0, 0.0)]
    alone = len({disc[:2] for disc in places}) == 1
    least = size * HALF_WIDTH * (2.0 if alone else 1.0)
    turn = 2 * np.pi * np.arange(CORNERS) / CORNERS
    rim = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    points = np.concatenate([np.array([x, y]) + max(radius, least) * rim for x, y, radius in places])
    outline = points[ConvexHull(points).vertices]  # counter-clockwise
    ahead = np.roll(outline, -1, axis=0)
    cross = outline[:, 0] * ahead[:, 1] - outline[:, 1] * ahead[:, 0]
    area = float(cross.sum() / 2)
    com = (cross[:, None] * (outline + ahead)).sum(axis=0) / (6 * area)
    about_origin = float((cross * ((outline * outline) + outline * ahead + ahead * ahead).sum(axis=1)).sum() / 12)
    surface = MATERIALS["aluminium"].density * THICKNESS * size
    return Estimate(surface * area, (float(com[0]), float(com[1])), surface * (about_origin - area * float(com @ com)))


# Takes the mass of each body from mechanism.py, else from its parts, else from an estimate.

Source = Literal["mechanism", "parts", "estimate"]
LISTED = 8
"""At most so many masses are listed in a line."""
ALIKE = 1e-9
"""Masses of mechanism.py and of the parts that differ by less, relatively, are one."""


def give_masses(m: Mechanism, parts: Parts | None) -> tuple[dict[str, Source], list[str]]:
    """Give each body of ``m`` without a mass that of its parts, else an estimate.

    A body whose mass or inertia mechanism.py gives keeps it; one that the parts leave out gets an estimate. Returns
    where each mass is from, and a sentence on each thing that a user may not expect. Raises UserError if parts and
    mechanism do not name the same bodies.
    """
    if parts is not None:
        _refuse_other_bodies(m, parts)
    if is_in_space(m):
        in_space: Any = m
        return give_masses_of_parts(in_space, bodies_of(parts) if parts is not None else {})  # pyright: ignore[reportReturnType]
    given = [name for name, body in m.bodies.items() if body.mass_given or body.mass > 0 or body.inertia > 0]
    solids = bodies_of(parts) if parts is not None else {}
    source: dict[str, Source] = {}
    for name in m.bodies:
        if name != "ground":
            source[name] = "mechanism" if name in given else "parts" if name in solids else "estimate"
    sentences = _estimate(m, [name for name in source if source[name] == "estimate"], parts is not None)
    if parts is None:
        return source, sentences
    for name in source:
        if source[name] == "parts":
            mass = solids[name].mass
            m.set_mass(name, mass.mass, mass.com, mass.inertia, mass.z, mass.products)
    differing = [
        f"{name} {written(m.bodies[name].mass, 'kg', 4)} (parts {written(solids[name].mass.mass, 'kg', 4)})"
        for name in source
        if source[name] == "mechanism" and name in solids and _differ(m.bodies[name].mass, solids[name].mass.mass)
    ]
    if differing:
        sentences.append(f"masses of mechanism.py count, not those of the parts: {_some(differing)}")
    rods = [f"{name} {written(rod.mass.mass, 'kg', 4)}" for name, rod in parts.bodies.items() if name not in solids]
    if rods:
        sentences.append(f"rods have no mass in the motion, because distance joints have none: {_some(rods)}")
    return source, sentences


def leaves_masses(m: Mechanism) -> bool:
    """Return True if mechanism.py leaves the mass of a body to its parts.

    ``m`` then has estimates in their place.
    """
    if is_in_space(m):
        return any(lacks_mass(body) for name, body in m.bodies.items() if name != "ground")
    return "estimate" in give_masses(m, None)[0].values()


def give_masses_aloud(stage: str, name: str, m: Mechanism, parts: Parts | None) -> None:
    """:func:`give_masses` of the mechanism ``name``; its sentences are said in the name of ``stage``."""
    sources, sentences = give_masses(m, parts)
    of_parts = [body for body, source in sources.items() if source == "parts"]
    if of_parts:
        sentences = [f"masses of the parts: {', '.join(of_parts)}", *sentences]
    for sentence in sentences:
        say(stage, f"{name}: {sentence}")


def bodies_of(parts: Parts) -> dict[str, BodyParts]:
    """Return the bodies of parts.json without rods and other links of joints, which mechanism.py does not have."""
    return {name: body for name, body in parts.bodies.items() if body.spans is None and not body.link}


def _estimate(m: Mechanism, names: list[str], left_out: bool) -> list[str]:
    """Give these bodies the mass of plates; the sentence that says so."""
    if not names:
        return []
    estimates = estimated_masses(m)
    for name in names:
        m.set_mass(name, estimates[name].mass, estimates[name].com, estimates[name].inertia)
    masses = _some([f"{name} {written(estimates[name].mass, 'kg')}" for name in names])
    why = "bodies without solids" if left_out else "no parts yet, so masses"
    return [f"{why} are estimated as aluminium bars and plates through the markers: {masses}"]


def _some(masses: list[str]) -> str:
    """Return the first of them, and how many others there are."""
    more = len(masses) - LISTED
    return ", ".join(masses) if more <= 1 else f"{', '.join(masses[:LISTED])} and {more} others"


def _differ(first: float, second: float) -> bool:
    return abs(first - second) > ALIKE * max(first, second)


def _refuse_other_bodies(m: Mechanism, parts: Parts) -> None:
    bodies = set(m.bodies) - {"ground"}
    solids = {*bodies_of(parts), *parts.without_solids} - {"ground"}
    for missing, where, there in ((bodies - solids, "parts.py", solids), (solids - bodies, "mechanism.py", bodies)):
        if missing:
            raise UserError(
                f"{m.name}: {where} has no body '{min(missing)}'; it has: {', '.join(sorted(there)) or 'none'}"
                f"{did_you_mean(min(missing), there) or '.'} mechanism.py and parts.py must name the same bodies "
                "(Bodies.leave_out names one without solids)"
            )


# The motion of a mechanism from mechanism.py alone, before there are any parts.


def bare_solution(name: str, masses: Mapping[str, Mass] | None = None) -> Solution:
    """Solve a mechanism with the masses of mechanism.py.

    Where it gives none, with ``masses`` or estimated ones.

    Poses of a mechanism whose drivers fix every freedom do not depend on masses; those of a simulation do, so parts
    made for it follow from a motion with their own masses (automatic_solids.py). Raises UserError.
    """
    m, module, p = solving.model_of(name)
    if is_in_space(m):
        return solving.motion_of(name, module, m, p)
    sources, _ = give_masses(m, None)
    for body in (body for body, source in sources.items() if source == "estimate" and body in (masses or {})):
        mass = (masses or {})[body]
        m.set_mass(body, mass.mass, mass.com, mass.inertia)
    return solving.motion_of(name, module, m, p)


def depends_on_masses(name: str, solution: Solution) -> bool:
    """Return True if the motion is a simulation of bodies some of which have no mass in mechanism.py."""
    if is_in_space(solution):
        return False  # a simulation in space has its masses from mechanism.py
    return solution.work is not None and leaves_masses(solving.model_of(name)[0])
