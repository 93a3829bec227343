"""The base in space: a plate below all that moves, and posts from it to the joints of ground where nothing passes."""

from __future__ import annotations

import math
from itertools import pairwise

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.space import round as shapes
from mechanisms.stages.automatic.space.moves import Array, Moves
from mechanisms.stages.automatic.space.pieces import Line, Part, Stand
from mechanisms.stages.automatic.space.round import across
from shared.stage.errors import UserError

WAYS = 16
"""Directions in which a post may stand aside of its joint."""
STEPS = (0.0, 4.0, 7.0, 11.0, 16.0, 22.0, 30.0, 40.0)
"""How far aside, in rods."""
POST = 1.15
"""Radius of a post, in rods."""
NEAR = 0.35
"""Distance that moving parts keep from a post, in rods."""
BELOW = 2.5
"""The plate lies so far below all that moves, in rods."""
FINE = 1.5
"""Distance of the points in which moving parts are looked at, in rods."""


class Base:
    """Where posts and plate stand, ``up`` being against gravity."""

    def __init__(self, moves: Moves, lines: dict[str, list[Line]], stands: list[Stand], up: Array) -> None:
        self.moves, self.sizes, self.up, self.stands = moves, moves.sizes, up, stands
        self.cloud, self.reach = self._swept(lines)
        low = [float((self.cloud @ up - self.reach).min())] if len(self.cloud) else []
        low += [float(place @ up) - stand.reach for stand in stands for place in (stand.ends or (stand.place,))]
        self.floor = _floor(moves, up)
        self.top = min(low, default=0.0) - BELOW * self.sizes.rod if self.floor is None else self.floor
        """Height of the upper face of the plate along ``up``."""

    def parts(self) -> list[Part]:
        """Return the plate and what stands on it. Raises UserError for a joint that no post can hold."""
        feet: list[Array] = []
        made: list[Part] = []
        for stand in self.stands:
            posts = [self._post(stand, place) for place in (stand.ends or (stand.place,))]
            aside = posts[0][1]
            shape, holes = stand.shape(aside / np.linalg.norm(aside) if aside.any() else -self.up)
            made.append((f"stand_{stand.joint}", shape, stand.material, holes))
            for k, (head, aside) in enumerate(posts):
                made.append((f"post_{stand.joint}_{k + 1}", self._column(stand, head, aside), "aluminium", 0))
                feet.append(head + aside)
        return [("base_plate", self._plate(feet), "aluminium_black", 0), *made]

    def _post(self, stand: Stand, place: Array) -> tuple[Array, Array]:
        """Return where a post meets the part of a joint, and how far aside (3,) it stands."""
        s, flat = self.sizes, across(self.up)
        side = np.cross(self.up, flat)
        through = stand.bore > 0.0 and abs(stand.axis @ self.up) > 0.2  # a post would meet the shaft
        for step in STEPS:
            for turn in range(WAYS if step else 1):
                angle = 2.0 * math.pi * turn / WAYS
                aside = step * s.rod * (math.cos(angle) * flat + math.sin(angle) * side)
                if stand.bore and step and abs(aside @ stand.axis) > 0.2 * step * s.rod:
                    continue  # it would meet the collars of the shaft
                if not step and through:
                    continue
                path = [place, place + aside, self._foot(place + aside)]
                if self._is_clear(path, place, stand.reach):
                    return place, aside
        raise UserError(
            f"{self.moves.m.name}: no post can hold joint '{stand.joint}' on ground: something passes wherever it "
            "could stand; write a parts.py that holds it"
        )

    def _foot(self, place: Array) -> Array:
        return place + (self.top - place @ self.up) * self.up

    def _is_clear(self, path: list[Array], joint: Array, reach: float) -> bool:
        """Return True if nothing that moves comes near a path, but for what the joint itself holds."""
        if not len(self.cloud):
            return True
        far = np.linalg.norm(self.cloud - joint, axis=1) - self.reach > reach + 0.5 * self.sizes.rod
        cloud, room = self.cloud[far], self.reach[far] + (POST + NEAR) * self.sizes.rod
        for a, b in pairwise(path):
            if not len(cloud):
                return True
            way = b - a
            part = np.clip((cloud - a) @ way / max(float(way @ way), 1e-12), 0.0, 1.0)
            if (np.linalg.norm(cloud - a - part[:, None] * way, axis=1) < room).any():
                return False
        return True

    def _column(self, stand: Stand, head: Array, aside: Array) -> cq.Workplane:
        """Return a post with its foot, up to the part that it holds."""
        s, radius = self.sizes, POST * self.sizes.rod
        foot = self._foot(head + aside)
        solids = [shapes.disc(foot + 0.35 * s.rod * self.up, self.up, 2.6 * s.rod, 0.35 * s.rod)]
        step = float(np.linalg.norm(aside))
        if step == 0.0:
            top = head - (stand.reach - 0.25 * s.rod if not stand.ends else 0.0) * self.up
            solids.append(shapes.rod(foot, top, radius))
            return shapes.fused(solids, [])
        way = aside / step
        start = head + (stand.reach - 0.25 * s.rod) * way
        solids += [shapes.rod(foot, head + aside, radius), shapes.ball(head + aside, radius, self.up)]
        solids.append(shapes.rod(start, head + aside, radius))
        return shapes.fused(solids, [])

    def _plate(self, feet: list[Array]) -> cq.Workplane:
        """Return the plate, under all posts and most of what moves."""
        s, flat = self.sizes, across(self.up)
        side = np.cross(self.up, flat)
        points = np.array(feet) if feet and self.floor is None else np.array([*self.cloud, *feet])
        u, v = points @ flat, points @ side
        room = 5.0 * s.rod
        half = (float(np.ptp(u)) / 2 + room, float(np.ptp(v)) / 2 + room)
        middle = (u.max() + u.min()) / 2 * flat + (v.max() + v.min()) / 2 * side + (self.top - 0.9 * s.rod) * self.up
        made = shapes.box(middle, flat, side, (*half, 0.9 * s.rod))
        plane = cq.Workplane(obj=made)
        upright = plane.edges(cq.selectors.ParallelDirSelector(cq.Vector(*self.up)))
        return upright.fillet(1.8 * s.rod)

    def _swept(self, lines: dict[str, list[Line]]) -> tuple[Array, Array]:
        """Return points (n, 3) in moving parts over the motion, and the radii (n,) about them (mm)."""
        clouds: list[Array] = [np.zeros((0, 3))]
        radii: list[Array] = [np.zeros(0)]
        for body, own in lines.items():
            for a, b, radius in own:
                count = max(2, math.ceil(float(np.linalg.norm(b - a)) / (FINE * self.sizes.rod)) + 1)
                points = a + np.linspace(0.0, 1.0, count)[:, None] * (b - a)
                world = self.moves.world(body, points).reshape(-1, 3)
                clouds.append(world)
                radii.append(np.full(len(world), radius))
        return np.concatenate(clouds), np.concatenate(radii)


def _floor(moves: Moves, up: Array) -> float | None:
    """Return the height along ``up`` of the level plane of ground on which bodies roll (mm); None without.

    Raises UserError for a plane that is not level or not ground's, and for two heights.
    """
    heights: list[float] = []
    for pair in moves.rolling():
        height = float(moves.place(pair.plane) @ up)
        level = pair.plane.body.name == "ground" and np.array(pair.plane.axis) @ up > 1.0 - 1e-9
        if not level or abs(height - (heights or [height])[0]) > 1e-6 * moves.sizes.rod:
            raise UserError(
                f"{moves.m.name}: '{pair.name}' rolls on a plane that is not one level floor of ground, for which "
                "there are no automatic parts; write a parts.py"
            )
        heights.append(height)
    return heights[0] if heights else None
