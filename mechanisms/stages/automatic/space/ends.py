"""Ends of bodies in space: what each joint asks of its two bodies, of ground and of its own massless link.

    revolute                  eyes side by side on a pin; on ground a journal in a bearing block
    cylindrical, prismatic    a shaft in a block; else a bush on a rail, round or square
    universal                 two yokes and a cross, which is the joint's link
    spherical                 a ball in a cup that opens to where its neck points
    distance, rod_with_fork   a rod with balls, which is the joint's link, in cups; of a fork an eye on a pin

Where a neck swings too far for a cup, the ball stands on a stud and the rod ends in a ring round it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import combinations

import cadquery as cq
import numpy as np

from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.joint import Joint
from mechanisms.stages.automatic.space import round as shapes
from mechanisms.stages.automatic.space.moves import MM, Array, Moves
from mechanisms.stages.automatic.space.round import across, unit
from shared.stage.errors import UserError

AXIAL = 0.85
"""Cosine to the axis of a joint above which a body runs along it."""
WIDEST_CUP, WIDEST_RING = math.radians(62.0), math.radians(34.0)
"""Largest swing of a neck in a cup, and of a ball's stud in a ring."""
RIM = math.radians(5.0)
"""Angle at the joint's centre between a neck that swings farthest and the rim of its cup."""
LEAVES = 0.45
"""Cosine to the pin above which a rod leaves an eye by an elbow."""
THIN = 0.8
"""Radius of a link's rod, in rods."""
COLLAR = 0.35
"""Half width of a collar, in rods."""
Line = tuple[Array, Array, float]
"""Two places and a radius (mm): a round part, for looking whether it meets others."""
Part = tuple[str, cq.Workplane, str, int]
"""Name, shape, material and through holes of a piece besides the main one."""


@dataclass
class End:
    """End of a body at a joint, in the body's frame (mm)."""

    joint: str
    node: Array
    """Where the body's rods arrive."""
    adds: list[cq.Shape] = field(default_factory=list)
    cuts: list[cq.Shape] = field(default_factory=list)
    holes: int = 0
    parts: list[Part] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)


@dataclass
class Stand:
    """Part that a joint asks of ground: one whose middle a post must hold."""

    joint: str
    place: Array
    axis: Array
    shape: Callable[[Array], tuple[cq.Workplane, int]]
    """Function of the direction to the post: the part, and its through holes."""
    reach: float
    """Radius of the part about its place."""
    material: str = "aluminium"
    ends: tuple[Array, ...] = ()
    """Places where posts arrive, if not at ``place``."""
    is_bored: bool = False
    """True if a shaft comes out of it at both sides along the axis."""


@dataclass
class Link:
    """The massless link of a joint: its main piece first, in its frame (mm)."""

    joint: str
    parts: list[Part]
    lines: list[Line]
    body: str = "ground"
    """Body to which its z axis is nearly fixed; its x axis goes from the first to the second place of the joint."""
    z: Array = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    """Direction of this axis in the body's frame."""


class Ends:
    """Ends of all bodies of a mechanism, from its joints and their motion."""

    def __init__(self, moves: Moves) -> None:
        self.moves, self.sizes = moves, moves.sizes
        self.ends: dict[str, list[End]] = {name: [] for name in moves.m.bodies}
        self.stands: list[Stand] = []
        self.links: list[Link] = []
        joints = moves.joints()
        self.anchors: dict[str, dict[str, Array]] = {name: {} for name in moves.m.bodies}
        for joint in joints:
            for marker in (joint.i, joint.j):
                self.anchors[marker.body.name][joint.name] = moves.place(marker)
        self._refuse_meeting_joints()
        places = [moves.world(marker.body.name, moves.place(marker))[:, 0] for j in joints for marker in (j.i, j.j)]
        self.middle = np.mean(np.concatenate(places), axis=0) if places else np.zeros(3)
        for joint in sorted(joints, key=self._is_arm):  # arms lie in the plane of their other ends
            self._shape(joint)

    def _refuse_meeting_joints(self) -> None:
        for body, anchors in self.anchors.items():
            for (name, place), (other, another) in combinations(anchors.items(), 2):
                if body != "ground" and np.linalg.norm(place - another) < self.sizes.rod:
                    raise UserError(
                        f"{self.moves.m.name}: joints '{name}' and '{other}' of '{body}' are on one place, where their "
                        "parts would meet. Move one aside (a hinge or slide acts anywhere along its axis, a slide also "
                        "beside it), or write a parts.py"
                    )

    # -- joints -------------------------------------------------------------------------------------------------

    def _shape(self, joint: Joint) -> None:
        made: dict[str, Callable[[Joint], None]] = {
            "revolute": self._revolute, "cylindrical": self._sliding, "prismatic": self._sliding,
            "universal": self._universal, "spherical": self._spherical, "distance": self._rod,
            "rod_with_fork": self._rod,
        }  # fmt: skip
        if joint.kind.name not in made:
            raise UserError(
                f"{self.moves.m.name}: there are no automatic parts for the {joint.kind.name} joint '{joint.name}' in "
                "space; write a parts.py that returns the solids of all bodies"
            )
        made[joint.kind.name](joint)

    def _revolute(self, joint: Joint) -> None:
        if "ground" in joint.bodies:
            self._journal(joint)
            return
        side = self._nearer_side(joint)
        for marker, way in ((joint.i, 1.0), (joint.j, -1.0)):
            arm = self._side_of_arm(marker)
            if arm:
                side = arm * way
                break
        for marker, way in ((joint.i, side), (joint.j, -side)):
            self._eye(joint, marker, way, pinned=marker is joint.i)

    def _nearer_side(self, joint: Joint) -> float:
        """Return the side along a pin on which the eye of body i stands: that of the rest of its body."""
        lean = [
            (self._toward(marker) - self.moves.place(marker)) @ np.array(marker.axis) for marker in (joint.i, joint.j)
        ]
        return -1.0 if lean[0] - lean[1] < -0.1 * self.sizes.rod else 1.0

    def _eye(self, joint: Joint, marker: Marker, way: float, pinned: bool) -> None:
        s, place, axis = self.sizes, self.moves.place(marker), np.array(marker.axis)
        radius, half = s.eye
        middle = place + way * s.lap * axis
        reach = 2 * half + s.play + 0.3 * s.rod
        end = End(joint.name, middle, [shapes.disc(middle, axis, radius, half)], holes=1)
        end.cuts = [shapes.disc(middle, axis, s.pin + (0.02 if pinned else s.play), half + 0.2 * s.rod)]
        end.lines = [(middle - half * axis, middle + half * axis, radius)]
        rest = self._toward(marker) - middle
        if abs(unit(rest) @ axis) > LEAVES:  # past the head of the pin
            elbow = middle + (radius + 1.2 * s.rod) * across(axis, rest)
            end.node, end.adds = elbow, [*end.adds, shapes.rod(middle, elbow, s.rod), shapes.ball(elbow, s.rod)]
            end.lines.append((middle, elbow, s.rod))
        if pinned:
            heads = [
                shapes.disc(place + e * (reach + 0.2 * s.rod) * axis, axis, 1.35 * s.pin, 0.25 * s.rod) for e in (1, -1)
            ]
            pin = shapes.fused([shapes.disc(place, axis, s.pin, reach), *heads], [])
            end.parts.append(("pin", pin, "steel", 0))
            head = (reach + 0.45 * s.rod) * axis
            end.lines.append((place - head, place + head, 1.35 * s.pin))
        self.ends[marker.body.name].append(end)

    def _journal(self, joint: Joint) -> None:
        """Shape a shaft in a bearing block, with collars where it does not slide."""
        s = self.sizes
        own, ground = self._sides(joint)
        place, axis = self.moves.place(own), np.array(own.axis)
        fixed = MM * np.array(ground.place)
        radius = self._shaft_radius(own)
        collar, held = radius + 0.6 * s.rod, joint.kind.name == "revolute"
        far = s.block + s.play + 2 * COLLAR * s.rod
        end = End(joint.name, place)
        if self._is_arm(joint):
            side = self._side(joint)
            nodes = [(other.node - place) @ axis for other in self.ends[own.body.name]]
            offset = float(np.mean(nodes)) if nodes else 0.0
            end.node = place + offset * axis
            boss = end.node
            swept = [shapes.extent(line, side * axis) for other in self.ends[own.body.name] for line in other.lines]
            face = max([side * (place @ axis + offset) + s.eye[1], *swept])  # beyond all that sweeps under the block
            bearing = side * (face + s.play + s.block) - place @ axis
            tip = place + (bearing + side * far) * axis
            end.adds = [shapes.disc(boss, axis, s.eye[0], s.eye[1]), shapes.rod(boss, tip, radius)]
            end.adds.append(shapes.disc(tip - side * COLLAR * s.rod * axis, axis, collar, COLLAR * s.rod))
            end.lines = [(boss - s.eye[1] * axis, boss + s.eye[1] * axis, s.eye[0])]
        else:
            bearing = 0.0
            end.adds = [shapes.disc(place, axis, radius, far + 0.4 * s.rod)]
            for way in (1.0, -1.0) if held else ():
                at = place + way * (s.block + s.play + COLLAR * s.rod) * axis
                end.adds.append(shapes.disc(at, axis, collar, COLLAR * s.rod))
        world = np.array(ground.axis)
        self.ends[own.body.name].append(end)
        self._block(joint.name, fixed + bearing * world, world, radius + s.play)

    def _block(self, joint: str, place: Array, axis: Array, bore: float) -> None:
        s, outer = self.sizes, bore + self.sizes.wall

        def shape(way: Array) -> tuple[cq.Workplane, int]:
            bored = shapes.disc(place, axis, bore, s.block + s.rod)
            return shapes.fused([shapes.disc(place, axis, outer, s.block)], [bored]), 1

        self.stands.append(Stand(joint, place, axis, shape, outer, is_bored=True))

    def _sliding(self, joint: Joint) -> None:
        """Shape a shaft in a block of ground, or a bush on a rail."""
        if "ground" in joint.bodies and not self._is_arm(joint):
            self._journal(joint)
            return
        s, square = self.sizes, joint.kind.name == "prismatic"
        rail, bush = joint.i, joint.j
        if joint.j.body.name == "ground" or (self._runs_along(joint.j) and not self._runs_along(joint.i)):
            rail, bush = joint.j, joint.i
        place, axis = self.moves.place(rail), np.array(rail.axis)
        half = 1.3 * s.block
        seen = self.moves.seen(rail.body.name, self.moves.world(bush.body.name, self.moves.place(bush))[:, 0])
        way = (seen - place) @ axis
        low, high = float(way.min()) - half - 3.4 * s.rod, float(way.max()) + half + 3.4 * s.rod
        start, stop = place + low * axis, place + high * axis
        side = np.array(rail.across)
        width = self._shaft_radius(rail) if self._runs_along(rail) else s.rod
        solid = (
            shapes.box((start + stop) / 2, axis, side, ((high - low) / 2, width, width))
            if square
            else shapes.rod(start, stop, width)
        )
        self._bush(joint, bush, half, width, square)
        if rail.body.name != "ground":
            nodes = self._others(rail)
            node = (
                min((start, stop), key=lambda end: float(np.linalg.norm(end - np.mean(nodes, axis=0))))
                if nodes
                else start
            )
            node = place if self._runs_along(rail) else node
            self.ends[rail.body.name].append(End(joint.name, node, [solid], lines=[(start, stop, width)]))
            return
        holder = 1.2 * s.rod

        def shape(way: Array) -> tuple[cq.Workplane, int]:
            return shapes.fused([solid], []), 0

        self.stands.append(
            Stand(
                joint.name,
                (start + stop) / 2,
                axis,
                shape,
                width,
                "steel",
                (start + holder * axis, stop - holder * axis),
            )
        )

    def _bush(self, joint: Joint, marker: Marker, half: float, width: float, square: bool) -> None:
        s, place, axis = self.sizes, self.moves.place(marker), np.array(marker.axis)
        outer = width * (1.42 if square else 1.0) + s.play + s.wall
        end = End(joint.name, place, [shapes.disc(place, axis, outer, half)], holes=1)
        gap = width + s.play
        side = np.array(marker.across)
        end.cuts = [
            shapes.box(place, axis, side, (half + s.rod, gap, gap))
            if square
            else shapes.disc(place, axis, gap, half + s.rod)
        ]
        end.lines = shapes.tube_lines(place, axis, outer, half)
        self.ends[marker.body.name].append(end)

    def _universal(self, joint: Joint) -> None:
        s = self.sizes
        inner, wall, width = 2.0 * s.rod, 1.0 * s.rod, 1.5 * s.rod
        depth, bridge = 3.8 * s.rod, 1.1 * s.rod
        for marker in (joint.i, joint.j):
            place, axis = self.moves.place(marker), np.array(marker.axis)
            if marker.body.name == "ground":
                self._stand_with_yoke(joint, marker, inner, wall, width, depth, bridge)
                continue
            back = across(axis, self._toward(marker) - place)
            end = End(joint.name, place + (depth + 0.5 * bridge) * back, holes=2)
            end.adds = shapes.yoke(place, axis, back, inner, wall, width, depth, bridge)
            end.cuts = [shapes.disc(place, axis, 0.75 * s.rod + s.play, inner + 2 * wall)]
            end.lines = [(place, place + depth * back, inner + wall)]
            self.ends[marker.body.name].append(end)
        x, y, zero = np.eye(3)[0], np.eye(3)[1], np.zeros(3)
        arms = [shapes.disc(zero, axis, 0.75 * s.rod, inner + wall) for axis in (x, y)]
        hub = shapes.ball(zero, 1.45 * s.rod, np.eye(3)[2])
        self.links.append(Link(joint.name, [("cross", shapes.fused([hub, *arms], []), "brass", 0)], []))

    def _stand_with_yoke(
        self, joint: Joint, marker: Marker, inner: float, wall: float, width: float, depth: float, bridge: float
    ) -> None:
        s, place, axis = self.sizes, MM * np.array(marker.place), np.array(marker.axis)

        def shape(way: Array) -> tuple[cq.Workplane, int]:
            back = across(axis, way)
            solids = shapes.yoke(place, axis, back, inner, wall, width, depth, bridge)
            return shapes.fused(solids, [shapes.disc(place, axis, 0.75 * s.rod + s.play, inner + 2 * wall)]), 2

        self.stands.append(Stand(joint.name, place, axis, shape, depth))

    def _spherical(self, joint: Joint) -> None:
        """Shape a ball on one body and a cup on the other, whichever way swings less; ground has the cup."""
        choices = []
        for ball, cup in ((joint.i, joint.j), (joint.j, joint.i)):
            if ball.body.name != "ground":
                neck = (
                    unit(self._toward(ball) - self.moves.place(ball)) if self._has_rest(ball) else np.array([0, 0, 1.0])
                )
                opening, swing = self._swing(cup.body.name, self.moves.turned(ball.body.name, neck))
                choices.append((swing, ball, cup, neck, opening))
        swing, ball, cup, neck, opening = min(choices, key=lambda choice: choice[0])
        s, place = self.sizes, self.moves.place(ball)
        end = End(joint.name, place, [shapes.ball(place, s.ball, neck)], lines=[(place, place, s.ball)])
        self.ends[ball.body.name].append(end)
        shape = ball.body.shape
        own = MM * shape.radius if shape is not None and shape.kind == "rod" else 0.0
        self._cup(joint, cup, opening, swing, own or s.rod)

    def _swing(self, body: str, world: Array) -> tuple[Array, float]:
        """Return the mean of directions (T, 3) of the world as a body sees them, and the largest angle to it (rad)."""
        seen = np.einsum("tji,tj->ti", self.moves.poses[body][1], world)
        mean = seen.sum(axis=0)
        if np.linalg.norm(mean) < 0.05 * len(seen):
            return seen[0], math.pi
        return unit(mean), float(np.arccos(np.clip(seen @ unit(mean), -1.0, 1.0)).max())

    def _cup(self, joint: Joint, marker: Marker, opening: Array, swing: float, neck: float) -> None:
        """Shape a cup that opens along ``opening`` for a ball whose neck, of that radius, swings so far."""
        if swing > WIDEST_CUP:
            raise UserError(
                f"{self.moves.m.name}: joint '{joint.name}' swings by {math.degrees(swing):.0f} degrees to both sides "
                f"in '{marker.body.name}', too far for a ball in a cup ({math.degrees(WIDEST_CUP):.0f}); write a "
                "parts.py"
            )
        s, place = self.sizes, self.moves.place(marker)
        rim = s.ball * min(0.3, math.cos(swing + math.asin(min(neck / s.ball, 1.0)) + RIM))
        if marker.body.name == "ground":

            def shape(way: Array) -> tuple[cq.Workplane, int]:
                return shapes.fused([shapes.ball(place, s.cup, opening)], self._hollow(place, opening, rim)), 0

            self.stands.append(Stand(joint.name, place, opening, shape, s.cup))
            return
        back = place - (s.cup + 0.6 * s.rod) * opening
        end = End(
            joint.name, back, [shapes.ball(place, s.cup, opening), shapes.rod(place - s.ball * opening, back, s.rod)]
        )
        end.cuts = self._hollow(place, opening, rim)
        end.lines = [(place, place, s.cup), (place, back, s.rod)]
        rest = self._toward(marker) - place if self._has_rest(marker) else -opening
        if unit(rest) @ opening > -0.5:
            end.adds.append(shapes.ball(back, s.rod, opening))
        else:
            end.node = place - 0.8 * s.cup * opening
        self.ends[marker.body.name].append(end)

    def _hollow(self, place: Array, opening: Array, rim: float) -> list[cq.Shape]:
        s, side = self.sizes, across(opening)
        reach = 1.5 * s.cup
        away = shapes.box(place + (rim + reach) * opening, opening, side, (reach, reach, reach))
        return [shapes.ball(place, s.ball + s.play, opening), away]

    def _rod(self, joint: Joint) -> None:
        """Shape a rod with balls at its ends, or with an eye on a pin at its fork, as the joint's link."""
        s, length = self.sizes, MM * float(joint.params["length"])
        way = self.moves.world(joint.j.body.name, self.moves.place(joint.j))[:, 0]
        way = way - self.moves.world(joint.i.body.name, self.moves.place(joint.i))[:, 0]
        way = way / np.linalg.norm(way, axis=1, keepdims=True)
        x, z, zero = np.eye(3)[0], np.eye(3)[2], np.zeros(3)
        solids, cuts, holes, ends = [], [], 0, [zero, length * x]
        first: list[tuple[Marker, float, int]] = [(joint.i, 1.0, 0), (joint.j, -1.0, 1)]
        if joint.kind.name == "rod_with_fork":
            radius, half = s.eye
            ends[0] = s.lap * z
            solids.append(shapes.disc(ends[0], z, radius, half))
            cuts.append(shapes.disc(ends[0], z, s.pin + s.play, half + 0.2 * s.rod))
            holes += 1
            self._eye(joint, joint.i, -1.0, pinned=True)
            first = first[1:]
        ringed, holder, upright = False, joint.i, across(np.array(joint.i.axis))
        if joint.kind.name == "rod_with_fork":
            upright = np.array(joint.i.axis)
        for marker, sense, k in first:
            opening, swing = self._swing(marker.body.name, sense * way)
            if swing > WIDEST_CUP and joint.kind.name == "distance" and not ringed:
                ringed = True
                stud, upright = self._stud(joint, marker, sense * way)
                holder = marker
                self.ends[marker.body.name].append(stud)
                ball, ring, half, _ = s.ring
                solids.append(shapes.disc(ends[k], z, ring, half))
                cuts.append(shapes.ball(ends[k], ball + s.play, z))
                holes += 1
            else:
                self._cup(joint, marker, opening, swing, THIN * s.rod)
                solids.append(shapes.ball(ends[k], s.ball, x))
        solids.insert(0, shapes.rod(ends[0], ends[1], THIN * s.rod))
        main = ("rod", shapes.fused(solids, cuts), "steel", holes)
        self.links.append(Link(joint.name, [main], [(ends[0], ends[1], s.rod)], holder.body.name, upright))

    def _stud(self, joint: Joint, marker: Marker, way: Array) -> tuple[End, Array]:
        """Return a ball on a stud, about which a rod along ``way`` (T, 3) turns with its ring; and the stud's axis."""
        s, place = self.sizes, self.moves.place(marker)
        axis, lean = stud_axis(self.moves, marker, way)
        if lean > WIDEST_RING:
            raise UserError(
                f"{self.moves.m.name}: the rod '{joint.name}' swings too far at '{marker.body.name}' for a ball in a "
                f"cup, and leans by {math.degrees(lean):.0f} degrees in a ring ({math.degrees(WIDEST_RING):.0f}); "
                "write a parts.py"
            )
        arm = self._side_of_arm(marker, axis)
        side = arm or (1.0 if axis @ (self._toward(marker) - place) >= 0.0 else -1.0)
        ball, ring, half, stud = s.ring
        far = ring * math.sin(lean) + half * math.cos(lean) + 0.3 * s.rod
        rest = unit(self._toward(marker) - place - side * far * axis)
        slope = max(-side * float(rest @ axis), 0.0)
        steep = math.sqrt(1.0 - min(slope, 0.9) ** 2)
        far += max(s.eye[1], steep * s.rod + (math.hypot(ring, half) + s.rod) * min(slope, 0.9) / steep)
        foot = place + side * far * axis  # so far that neither it nor the arm from there comes to the ring
        end = End(joint.name, foot, [shapes.ball(place, ball, axis), shapes.rod(place, foot, stud)])
        end.adds.append(shapes.disc(foot, axis, 1.35 * s.rod, s.eye[1]))
        end.lines = [(place, place, ball), (place, foot, stud), *shapes.tube_lines(foot, axis, 1.35 * s.rod, s.eye[1])]
        return end, axis

    # -- bodies about a joint -----------------------------------------------------------------------------------

    def _sides(self, joint: Joint) -> tuple[Marker, Marker]:
        """Return the markers of a joint on the moving body and on ground."""
        return (joint.j, joint.i) if joint.i.body.name == "ground" else (joint.i, joint.j)

    def _others(self, marker: Marker) -> list[Array]:
        """Return the places of a body's other joints, and of its disc, ball or mass where it has few."""
        own = self.moves.place(marker)
        body = marker.body
        near = [p for p in self.anchors[body.name].values() if np.linalg.norm(p - own) > 0.5 * self.sizes.rod]
        shape = body.shape
        if shape is not None and shape.kind == "rod":
            near += [
                p
                for p in (np.zeros(3), np.array([MM * shape.length, 0.0, 0.0]))
                if np.linalg.norm(p - own) > self.sizes.rod
            ]
        elif shape is not None and np.linalg.norm(own) > self.sizes.rod:
            near.append(np.zeros(3))
        elif not near and np.linalg.norm(MM * np.array(body.com) - own) > self.sizes.rod:
            near.append(MM * np.array(body.com))
        return near

    def _has_rest(self, marker: Marker) -> bool:
        return bool(self._others(marker))

    def _toward(self, marker: Marker) -> Array:
        """Return the place to which a body's rod leads from a joint."""
        others = self._others(marker)
        return np.mean(others, axis=0) if others else self.moves.place(marker) + across(np.array(marker.axis))

    def _runs_along(self, marker: Marker) -> bool:
        """Return True if a body runs along the axis of a joint."""
        axis, own = np.array(marker.axis), self.moves.place(marker)
        others = self._others(marker)
        return all(abs(unit(other - own) @ axis) > AXIAL for other in others)

    def _is_arm(self, joint: Joint) -> bool:
        """Return True if a joint with ground holds a body that stands across its axis."""
        if "ground" not in joint.bodies or joint.kind.name not in ("revolute", "cylindrical", "prismatic"):
            return False
        return not self._runs_along(self._sides(joint)[0])

    def _side(self, joint: Joint) -> float:
        """Return the side along the axis on which the bearing of an arm stands: away from the mechanism's middle."""
        ground = self._sides(joint)[1]
        return 1.0 if (MM * np.array(ground.place) - self.middle) @ np.array(ground.axis) >= -1e-6 else -1.0

    def _side_of_arm(self, marker: Marker, axis: Array | None = None) -> float:
        """Return the side of the bearing of a body that is an arm about a parallel axis; 0 if it is none."""
        along = np.array(marker.axis) if axis is None else axis
        for joint in self.moves.joints():
            if marker.body.name in joint.bodies and joint.kind.name == "revolute" and self._is_arm(joint):
                own = np.array(self._sides(joint)[0].axis)
                if abs(own @ along) > AXIAL:
                    return self._side(joint) * float(np.sign(own @ along))
        return 0.0

    def _shaft_radius(self, marker: Marker) -> float:
        shape = marker.body.shape
        along = shape is not None and shape.kind == "rod" and abs(marker.axis[0]) > AXIAL
        return MM * shape.radius if along and shape is not None and shape.radius > 0.0 else self.sizes.rod


def stud_axis(moves: Moves, marker: Marker, way: Array) -> tuple[Array, float]:
    """Return the direction of a body that stays most across ``way`` (T, 3) of the world, and the largest lean (rad)."""
    seen = np.einsum("tji,tj->ti", moves.poses[marker.body.name][1], way)
    axis = np.linalg.svd(seen, full_matrices=False)[2][2]
    return axis, float(np.arcsin(np.clip(np.abs(seen @ axis), 0.0, 1.0)).max())
