"""Findings about a model: links that do not close, gears whose teeth do not mesh, and change points.

A closed chain of four links has change points, poses with all links in line where two assemblies meet, where

    pins alone       s + l = p + q      s, l: the shortest and the longest link; p, q: the others
    crank and slide  e = |l - r|        r, l: crank and rod; e: distance of the crank's pin from the line of the slider

Bodies that are welded to each other are one link. Lengths are those between pins in the pose at the start.
Source: Grashof 1883; Norton, Design of Machinery, ch. 2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed, pack
from mbsd.arrays.starts import relative_poses
from mbsd.base.errors import MechanismError
from mbsd.base.names import Suggesting
from mbsd.dynamics.prepare.large import mobility
from mbsd.kinematics.pose.close import assemble
from mbsd.model.mechanism import Model
from mbsd.model.teeth import with_radii


@dataclass(frozen=True)
class Finding(Suggesting):
    """One suspicious number: whose it is, what is odd, what to do."""

    name: str
    problem: str
    remedy: str
    is_note: bool = False
    """True if it is something to know of a model that may well be meant so."""

    def __str__(self) -> str:
        return f"{self.name}: {self.problem}. {self.remedy}"


ROOM = 0.1
"""Part of the smaller radius by which centres of gears without teeth may stand elsewhere."""
START_REMEDY = "Look at lengths and places of what it names; m.draw() shows the rough start"


def start_problems(m: Model) -> Iterator[Finding]:
    """Yield the reasons why ``m`` cannot be assembled: open links, gears apart, a rack on the other side."""
    try:
        mobility(m)
    except MechanismError as error:
        problem, _, remedy = str(error).removeprefix(f"{m.name}: ").partition(". ")
        yield Finding("start", problem.rstrip("."), remedy.rstrip(".") or START_REMEDY)
        return
    yield from _meshes_apart(m)


def _meshes_apart(m: Model) -> Iterator[Finding]:
    """Yield gears with play whose centres are too far from the sum of their radii for teeth to mesh."""
    if not any(force.kind.mesh for force in m.forces.values()):
        return
    packed = pack(m)
    q = assemble(m, packed, 0.0)
    for force in packed.forces:
        if force.kind.mesh is None:
            continue
        sized, (x, y, _) = with_radii(force.params), relative_poses(packed, force, q[None])
        first, second = sized["radius_i"], sized["radius_j"]
        wanted = first - second if force.params["internal"] else first + second
        distance, room = float(np.hypot(x, y)[0]), force.params.get("module", ROOM * min(first, second))
        if abs(distance - wanted) > room:
            yield Finding(
                f"force '{force.name}'",
                f"its centres are {distance:g} m apart at the start, and radii of {first:g} m and {second:g} m say "
                f"{wanted:g} m, so no teeth mesh",
                "Move a centre, or give other radii; a module is in metres: 3 mm is 3e-3",
            )


EQUAL = 1e-9
"""Part of the longest link by which sums of lengths may differ and count as equal."""
MOST_NAMED = 3
"""Chains that are named one by one."""
LINKS = 4
PIN, SLIDE = "pin", "guide"
"""Pairs of :class:`mbsd.model.joint.JointKind` that a chain may have."""
CHANGE_POINT_REMEDY = (
    "Sweeps and simulations pass such a pose on the smooth continuation, and reactions may grow without bound there. "
    "Choose the other way with sweep(switch_at=...), or change a length, or add a link that decides"
)


@dataclass(frozen=True)
class _Connection:
    """A pin or a slide between two links."""

    name: str
    pair: str
    links: tuple[int, int]
    place: np.ndarray
    """(2,) in the world at the start (m)."""
    axis: np.ndarray
    """(2,) of a slide."""

    def other(self, link: int) -> int:
        return self.links[1] if self.links[0] == link else self.links[0]


def change_point_chains(m: Model) -> list[Finding]:
    """Return a finding for each closed chain with change points; none where ``m`` does not close."""
    pairs = [joint.kind.pair for joint in m.joints.values()]
    if pairs.count(PIN) < LINKS - 1:
        return []
    try:
        packed = pack(m)
        q = assemble(m, packed, 0.0)
    except MechanismError:
        return []  # which other findings name
    links = _links(packed)
    chains = list(_chains(packed, links, q))
    reason = [_finding(packed, *chain) for chain in chains[:MOST_NAMED]]
    more = len(chains) - len(reason)
    if more > 0:
        reason.append(Finding("chains", f"{more} more closed chains have change points", CHANGE_POINT_REMEDY, True))
    return reason


def _links(packed: Packed) -> list[int]:
    """(bodies,) of the link that each body belongs to: the first of those welded to each other."""
    links = list(range(len(packed.body_names)))
    bodies = packed.system.marker_body[packed.markers]
    for joint, (a, b) in zip(packed.joints, bodies.tolist(), strict=True):
        if set(joint.kind.constraints) == {"point", "angle"}:  # welded
            first, second = sorted((links[a], links[b]))
            links = [first if link == second else link for link in links]
    return links


def _connections(packed: Packed, links: list[int], q: np.ndarray) -> list[_Connection]:
    system, out = packed.system, []
    for joint, (i, _), bodies in zip(
        packed.joints, packed.markers.tolist(), system.marker_body[packed.markers].tolist(), strict=True
    ):
        if joint.kind.pair not in (PIN, SLIDE) or links[bodies[0]] == links[bodies[1]]:
            continue
        x, y, theta = q[3 * bodies[0] : 3 * bodies[0] + 3]
        turn = np.array([[math.cos(theta), -math.sin(theta)], [math.sin(theta), math.cos(theta)]])
        place, axis = turn @ system.marker_arm[i] + (x, y), turn @ system.marker_axis[i]
        out.append(_Connection(joint.name, joint.kind.pair, (links[bodies[0]], links[bodies[1]]), place, axis))
    return out


def _chains(packed: Packed, links: list[int], q: np.ndarray) -> Iterator[tuple[list[int], str]]:
    """Links of each chain with change points, and the sum that says so."""
    around: dict[int, list[_Connection]] = {}
    for connection in _connections(packed, links, q):
        for link in connection.links:
            around.setdefault(link, []).append(connection)
    for chain, way in _closed(around):
        slides = [k for k, connection in enumerate(way) if connection.pair == SLIDE]
        if not slides:
            reason = _in_line([math.dist(way[k - 1].place, way[k].place) for k in range(LINKS)])
        elif len(slides) == 1:
            k = slides[0]
            reason = _slider_crank(*way[k + 1 :], *way[: k + 1])
        else:
            continue
        if reason:
            yield chain, reason


def _closed(around: dict[int, list[_Connection]]) -> Iterator[tuple[list[int], list[_Connection]]]:
    """Chains of four links, each once, and what connects each link with the next."""
    for first in sorted(around):
        for near in around[first]:
            second = near.other(first)
            for two in around[second]:
                third = two.other(second)
                if second <= first or third <= first or two is near or third == second:
                    continue
                for three in around[third]:
                    fourth = three.other(third)
                    if three is two or fourth <= second or fourth == third:
                        continue  # each chain is met in both directions
                    for four in around[fourth]:
                        if four is not three and four.other(fourth) == first and four is not near:
                            yield [first, second, third, fourth], [near, two, three, four]


def _in_line(lengths: list[float]) -> str:
    """The sum by which four links can lie in line; empty where they cannot."""
    shortest, *others, longest = sorted(lengths)
    if not shortest > EQUAL * longest or abs(shortest + longest - sum(others)) > EQUAL * longest:
        return ""
    return (
        f"the shortest and the longest link together are as long as the others: {shortest:g} + {longest:g} = "
        f"{others[0]:g} + {others[1]:g} m"
    )


def _slider_crank(near: _Connection, two: _Connection, three: _Connection, slide: _Connection) -> str:
    """The lengths for which the slider of a chain with three pins has change points; empty for others."""
    first, second = math.dist(near.place, two.place), math.dist(two.place, three.place)
    along, longest = three.place - near.place, max(first, second)
    offset = abs(float(along[0] * slide.axis[1] - along[1] * slide.axis[0]))
    if not min(first, second) > EQUAL * longest or abs(offset - abs(second - first)) > EQUAL * longest:
        return ""
    if offset > EQUAL * longest:
        return f"the offset of the slider is the difference of crank and rod: {offset:g} = |{first:g} - {second:g}| m"
    return f"crank and rod are equally long, {first:g} m, and the slider runs through the crank's pin"


def _finding(packed: Packed, chain: list[int], reason: str) -> Finding:
    names = " - ".join(packed.body_names[link] for link in chain)
    return Finding(
        f"chain {names}",
        f"it has change points, where two assemblies meet, because {reason}",
        CHANGE_POINT_REMEDY,
        True,
    )
