"""Ends of bodies in space: what joints ask of bodies, of ground and of massless links.

    revolute                  eyes side by side on a pin; on ground a journal in a bearing block;
                              a fork where a shaft ends; the hub of a disc on its axle
    cylindrical, prismatic    a shaft in a block; else a bush on a rail, round or square
    universal                 two yokes and a cross, which is the joint's link
    spherical                 a ball in a cup that opens to where its neck points
    distance, rod_with_fork   a rod with balls, which is the joint's link, in cups; of a fork an eye on a pin

Where a neck swings too far for a cup, the ball stands on a stud and the rod ends in a ring round it.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import cadquery as cq
import numpy as np

from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.joint import Joint
from mechanisms.stages.automatic.space import round as shapes
from mechanisms.stages.automatic.space.gears import bevel_wheels
from mechanisms.stages.automatic.space.moves import MM, Array, Moves
from mechanisms.stages.automatic.space.pieces import End, Link, Stand
from mechanisms.stages.automatic.space.round import across, unit
from mechanisms.stages.automatic.space.slides import is_telescope, telescope_ends, track_ends
from mechanisms.stages.automatic.space.surroundings import Surroundings
from mechanisms.stages.automatic.space.wheels import axle_ends, is_wheel, rims
from shared.stage.errors import UserError

WIDEST_CUP, WIDEST_RING = math.radians(62.0), math.radians(34.0)
"""Largest swing of a neck in a cup, and of a ball's stud in a ring."""
RIM = math.radians(5.0)
"""Angle at the joint's centre between a neck that swings farthest and the rim of its cup."""
LEAVES = 0.45
"""Cosine to the pin above which a rod leaves an eye by an elbow."""
CLEVIS = 3.4
"""Distance of a clevis' bridge from its pin, in rods."""
THIN = 0.8
"""Radius of a link's rod, in rods."""
COLLAR = 0.35
"""Half width of a collar, in rods."""


class Ends:
    """Ends of all bodies of a mechanism, from its joints and their motion."""

    def __init__(self, moves: Moves) -> None:
        self.moves, self.sizes = moves, moves.sizes
        self.ends: dict[str, list[End]] = {name: [] for name in moves.m.bodies}
        self.stands: list[Stand] = []
        self.links: list[Link] = []
        self.rims, self.bevels = rims(moves), bevel_wheels(moves)
        self.around = Surroundings(moves)
        joints = self.around.joints
        for joint in sorted(joints, key=self.around.is_arm):  # arms lie in the plane of their other ends
            self._shape(joint)
        for body, wheel in self.bevels.items():
            self.ends[body].append(wheel.end(self.sizes))

    # -- joints -------------------------------------------------------------------------------------------------

    def _shape(self, joint: Joint) -> None:
        made: dict[str, Callable[[Joint], None]] = {
            "revolute": self._revolute, "cylindrical": self._sliding, "prismatic": self._sliding,
            "universal": self._universal, "spherical": self._spherical, "distance": self._rod,
            "rod_with_fork": self._rod, "point_on_plane": self._track,
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
        for wheel, holder in ((joint.i, joint.j), (joint.j, joint.i)):
            if is_wheel(wheel):
                rest, front, bevel = self.around.toward(holder), None, self.bevels.get(wheel.body.name)
                if bevel is not None:  # the axle comes from behind the teeth
                    away = wheel.body.rotation @ bevel.axis
                    rest, front = self.moves.place(holder) + holder.body.rotation.T @ away, bevel.front()
                both = axle_ends(joint.name, wheel, holder, rest, self.sizes, self.rims.get(wheel.body.name), front)
                for marker, end in zip((wheel, holder), both, strict=True):
                    self.ends[marker.body.name].append(end)
                return
        for shaft, other in ((joint.i, joint.j), (joint.j, joint.i)):
            if self.around.is_shaft(shaft.body.name, joint):
                self._clevis(joint, shaft, other)
                return
            if self.around.has_rest(shaft) and self.around.runs_along(shaft) and not self.around.runs_along(other):
                self._neck(joint, shaft, other)
                return
        side = self._nearer_side(joint)
        for marker, way in ((joint.i, 1.0), (joint.j, -1.0)):
            arm = self.around.side_of_arm(marker)
            if arm:
                side = arm * way
                break
        for marker, way in ((joint.i, side), (joint.j, -side)):
            self._eye(joint, marker, way, pinned=marker is joint.i)

    def _clevis(self, joint: Joint, shaft: Marker, other: Marker) -> None:
        """Shape the fork in which a shaft ends, the eye between its cheeks and the pin through both."""
        s, place, axis = self.sizes, self.moves.place(shaft), np.array(shaft.axis)
        inner, wall, width, bridge = s.eye[1] + s.play, 0.9 * s.rod, 1.5 * s.rod, 1.2 * s.rod
        back = across(axis, self.around.toward(shaft) - place)
        end = End(joint.name, place + (CLEVIS * s.rod + 0.5 * bridge) * back, holes=2)
        end.adds = shapes.yoke(place, axis, back, inner, wall, width, CLEVIS * s.rod, bridge)
        end.cuts = [shapes.disc(place, axis, s.pin + 0.02, inner + 2 * wall)]
        sides = [side * (inner + wall / 2) * axis for side in (1.0, -1.0)]
        end.lines = [(place + side, place + side + CLEVIS * s.rod * back, wall / 2) for side in sides]
        reach = inner + wall + 0.1 * s.rod
        heads = [
            shapes.disc(place + e * (reach + 0.2 * s.rod) * axis, axis, 1.35 * s.pin, 0.2 * s.rod) for e in (1, -1)
        ]
        end.parts = [("pin", shapes.fused([shapes.disc(place, axis, s.pin, reach), *heads], []), "steel", 0)]
        self.ends[shaft.body.name].append(end)
        place, axis = self.moves.place(other), np.array(other.axis)
        eye = End(joint.name, place, [shapes.disc(place, axis, s.eye[0], s.eye[1])], holes=1)
        eye.cuts = [shapes.disc(place, axis, s.pin + s.play, s.eye[1] + 0.2 * s.rod)]
        eye.lines = [(place - s.eye[1] * axis, place + s.eye[1] * axis, s.eye[0])]
        self.ends[other.body.name].append(eye)

    def _nearer_side(self, joint: Joint) -> float:
        """Return the side along a pin on which the eye of body i stands: that of the rest of its body."""
        both = (joint.i, joint.j)
        lean = [(self.around.toward(m) - self.moves.place(m)) @ np.array(m.axis) for m in both]
        return -1.0 if lean[0] - lean[1] < -0.1 * self.sizes.rod else 1.0

    def _eye(self, joint: Joint, marker: Marker, way: float, pinned: bool) -> None:
        s, place, axis = self.sizes, self.moves.place(marker), np.array(marker.axis)
        radius, half = s.eye
        middle = place + way * s.lap * axis
        reach = 2 * half + s.play + 0.3 * s.rod
        end = End(joint.name, middle, [shapes.disc(middle, axis, radius, half)], holes=1)
        end.cuts = [shapes.disc(middle, axis, s.pin + (0.02 if pinned else s.play), half + 0.2 * s.rod)]
        end.lines = [(middle - half * axis, middle + half * axis, radius)]
        rest = self.around.toward(marker) - middle
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
        own, ground = self.around.sides(joint)
        place, axis = self.moves.place(own), np.array(own.axis)
        fixed = MM * np.array(ground.place)
        radius = self.around.shaft_radius(own)
        collar, held = radius + 0.6 * s.rod, joint.kind.name == "revolute"
        far = s.block + s.play + 2 * COLLAR * s.rod
        end = End(joint.name, place)
        if self.around.is_arm(joint):
            side = self.around.side(joint)
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
            end.adds = self._neck_solids(own, radius, s.block, held)
        world = np.array(ground.axis)
        self.ends[own.body.name].append(end)
        self._block(joint.name, fixed + bearing * world, world, radius + s.play)

    def _neck_solids(self, marker: Marker, radius: float, half: float, held: bool) -> list[cq.Shape]:
        """Return a shaft through a bearing of half width ``half``, with a collar at either side if it is held."""
        s, place, axis = self.sizes, self.moves.place(marker), np.array(marker.axis)
        out = [shapes.disc(place, axis, radius, half + s.play + (2 * COLLAR + 0.4) * s.rod)]
        for way in (1.0, -1.0) if held else ():
            at = place + way * (half + s.play + COLLAR * s.rod) * axis
            out.append(shapes.disc(at, axis, radius + 0.6 * s.rod, COLLAR * s.rod))
        return out

    def _neck(self, joint: Joint, shaft: Marker, holder: Marker) -> None:
        """Shape a body that runs along the axis as a shaft in the bush of another, as the head of a bicycle."""
        s, place, axis = self.sizes, self.moves.place(shaft), np.array(shaft.axis)
        radius, half = self.around.shaft_radius(shaft), 1.3 * s.block
        way = float(np.sign((self.around.toward(shaft) - place) @ axis)) * (half + s.play + 2 * COLLAR * s.rod)
        end = End(joint.name, place + way * axis, self._neck_solids(shaft, radius, half, True))
        self.ends[shaft.body.name].append(end)
        self._bush(joint, holder, half, radius, False)

    def _block(self, joint: str, place: Array, axis: Array, bore: float) -> None:
        s, outer = self.sizes, bore + self.sizes.wall

        def shape(way: Array) -> tuple[cq.Workplane, int]:
            bored = shapes.disc(place, axis, bore, s.block + s.rod)
            return shapes.fused([shapes.disc(place, axis, outer, s.block)], [bored]), 1

        self.stands.append(Stand(joint, place, axis, shape, outer, bore=bore))

    def _sliding(self, joint: Joint) -> None:
        """Shape a shaft in a block of ground, or a bush on a rail."""
        if "ground" in joint.bodies and not self.around.is_arm(joint):
            self._journal(joint)
            return
        if is_telescope(self.around, joint):
            self._append(joint, *telescope_ends(self.around, joint))
            return
        s, square = self.sizes, joint.kind.name == "prismatic"
        rail, bush = joint.i, joint.j
        if joint.j.body.name == "ground" or (self.around.runs_along(joint.j) and not self.around.runs_along(joint.i)):
            rail, bush = joint.j, joint.i
        place, axis = self.moves.place(rail), np.array(rail.axis)
        half = 1.3 * s.block
        seen = self.moves.seen(rail.body.name, self.moves.world(bush.body.name, self.moves.place(bush))[:, 0])
        way = (seen - place) @ axis
        low, high = float(way.min()) - half - 3.4 * s.rod, float(way.max()) + half + 3.4 * s.rod
        start, stop = place + low * axis, place + high * axis
        side = np.array(rail.across)
        width = self.around.shaft_radius(rail) if self.around.runs_along(rail) else s.rod
        solid = (
            shapes.box((start + stop) / 2, axis, side, ((high - low) / 2, width, width))
            if square
            else shapes.rod(start, stop, width)
        )
        self._bush(joint, bush, half, width, square)
        if rail.body.name != "ground":
            nodes = self.around.others(rail)
            node = (
                min((start, stop), key=lambda end: float(np.linalg.norm(end - np.mean(nodes, axis=0))))
                if nodes
                else start
            )
            node = place if self.around.runs_along(rail) else node
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

    def _track(self, joint: Joint) -> None:
        self._append(joint, *track_ends(self.around, joint))

    def _append(self, joint: Joint, first: End | None, second: End) -> None:
        for marker, end in ((joint.i, first), (joint.j, second)):
            if end is not None:
                self.ends[marker.body.name].append(end)

    def _bush(self, joint: Joint, marker: Marker, half: float, width: float, square: bool) -> None:
        s, place, axis = self.sizes, self.moves.place(marker), np.array(marker.axis)
        outer = width * (1.42 if square else 1.0) + s.play + s.wall
        end = End(joint.name, place, [shapes.disc(place, axis, outer, half)], holes=1, bush=axis)
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
            back = across(axis, self.around.toward(marker) - place)
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
                rest = self.around.toward(ball) - self.moves.place(ball)
                neck = unit(rest) if self.around.has_rest(ball) else np.array([0, 0, 1.0])
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
        whole = [shapes.ball(place, s.cup, opening), shapes.rod(place - s.ball * opening, back, s.rod)]
        cup = shapes.fused(whole, self._hollow(place, opening, rim)).val()
        end = End(joint.name, back, [cup])  # pyright: ignore[reportArgumentType]
        end.cuts = [shapes.ball(place, s.ball + s.play, opening)]
        end.lines = [(place, place, s.cup), (place, back, s.rod)]
        rest = self.around.toward(marker) - place if self.around.has_rest(marker) else -opening
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
        arm = self.around.side_of_arm(marker, axis)
        side = arm or (1.0 if axis @ (self.around.toward(marker) - place) >= 0.0 else -1.0)
        ball, ring, half, stud = s.ring
        far = ring * math.sin(lean) + half * math.cos(lean) + 0.3 * s.rod
        rest = unit(self.around.toward(marker) - place - side * far * axis)
        slope = max(-side * float(rest @ axis), 0.0)
        steep = math.sqrt(1.0 - min(slope, 0.9) ** 2)
        far += max(s.eye[1], steep * s.rod + (math.hypot(ring, half) + s.rod) * min(slope, 0.9) / steep)
        foot = place + side * far * axis  # so far that neither it nor the arm from there comes to the ring
        end = End(joint.name, foot, [shapes.ball(place, ball, axis), shapes.rod(place, foot, stud)])
        end.adds.append(shapes.disc(foot, axis, 1.35 * s.rod, s.eye[1]))
        end.lines = [(place, place, ball), (place, foot, stud), *shapes.tube_lines(foot, axis, 1.35 * s.rod, s.eye[1])]
        return end, axis


def stud_axis(moves: Moves, marker: Marker, way: Array) -> tuple[Array, float]:
    """Return the direction of a body that stays most across ``way`` (T, 3) of the world, and the largest lean (rad)."""
    seen = np.einsum("tji,tj->ti", moves.poses[marker.body.name][1], way)
    axis = np.linalg.svd(seen, full_matrices=False)[2][2]
    return axis, float(np.arcsin(np.clip(np.abs(seen @ axis), 0.0, 1.0)).max())
