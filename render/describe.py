"""From the files (data.json, parts.json, shot.json) to a scene in plain data, and to the state of each frame."""

from __future__ import annotations

import math
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render import writing
from render.arrows import Arrows
from render.clock import Clock
from render.framing import CameraPose, depth_of_field, fit, half_width, orbit
from render.framing import axes as camera_axes
from render.poses import Poses
from render.scene import LabelSpec, PieceSpec, Point, Scene, State, StudioSpec, SurfaceSpec, TrailSpec, Writing
from render.stretched import Stretched, placed, stretched
from render.swept import SweptSpace
from render.vectors import vectors
from shared.contract import Motion, Parts, Piece, Shape
from shared.errors import UserError
from shared.files import file_hash
from shared.materials import MATERIALS
from shared.shot import Names, Shot, Surface, Trail, refuse_unknown

Array = NDArray[np.float64]
TRAIL_RINGS, MOST_RINGS = 160, 3000
"""Of a trail: the fewest and the most."""
TRAIL_STRAY = 0.15
"""How far a trail may stray from its point's way between two rings, in its own radii."""
BENT = 0.995
"""Part of the motion over which that holds; stiff contacts accelerate a point at will for a moment."""
TRAIL_GAP = 0.001
"""Height (m) of a trail over the body that carries its point, if the shot gives none."""
LABEL_GAP = 0.012
"""Height of a label over its pin, as a part of the size of the swept motion."""


class Film:
    """Everything the film shows, without a picture yet."""

    def __init__(self, motion: Motion, parts: Parts, shot: Shot, folder: Path) -> None:
        """``folder`` holds the STL files. Raises UserError if names, bodies or files do not fit together."""
        self.motion, self.parts, self.shot, self.folder = motion, parts, shot, folder
        self.poses = Poses(motion)
        self.clock = Clock(motion, shot)
        refuse_unknown(shot, Names.of(motion, parts))
        self._refuse_mismatch()
        paths = {trail.point: self._trail_z(trail) for trail in self.trails}
        self.space = SweptSpace(self.poses, parts, folder, paths)
        self._ring_counts: dict[str, int] = {}
        self.number = writing.number(motion, shot)

    @property
    def trails(self) -> tuple[Trail, ...]:
        """The shot's trails; every traced point gets one if the shot says nothing."""
        return self.shot.trails if self.shot.trails is not None else tuple(Trail(point=p) for p in self.motion.points)

    @cached_property
    def scene(self) -> Scene:
        """The scene in plain data."""
        return Scene(
            mechanism=self.motion.mechanism,
            fps=self.shot.fps,
            pieces=[
                PieceSpec(
                    body=body,
                    name=name,
                    stl=str((self.folder / piece.stl).resolve()),
                    sha256=piece.stl_sha256,
                    surface=self._surface(body, name, piece),
                )
                for body, name, piece in self._pieces()
            ],
            trails=[
                TrailSpec(name=t.point, colour=t.colour, radius=t.radius * self.space.size, rings=self._rings(t))
                for t in self.trails
            ],
            labels=[LabelSpec(text=s.text, size=s.size * self.space.size, colour=s.colour) for s in self.shot.labels],
            studio=StudioSpec(
                look=self.shot.look,
                centre=_point(self.space.middle),
                radius=self.space.size / 2,
                floor=float(self.space.all[:, 2].min()),
                azimuth=math.radians(self.shot.camera.azimuth),
            ),
            tubes=[spec for one in self.stretched for spec, _ in one.tubes],
            arrows=self.arrows.specs(),
            writing=self._writing(),
        )

    def state(self, frame: int) -> State:
        """What frame ``frame`` shows; frames before 0 or after the first showing go on with the loop."""
        at = self.clock.moment(frame)
        return State(
            bodies={name: self.poses.body(name, at) for name in self.parts.bodies},
            trails=[self._path(trail, frame) for trail in self.trails],
            labels=[self._label_place(label.at, frame) for label in self.shot.labels],
            camera=self.camera(frame),
            tubes=[path for one in self.stretched for path in one.paths(self.poses, at)],
            arrows=self.arrows.at(at.time, self._arrow_heights),
            number=self.number(at.time),
        )

    @cached_property
    def arrows(self) -> Arrows:
        """What the shot shows by arrows."""
        return Arrows(self.poses.time, vectors(self.motion, self.shot.show), self.space.size)

    @cached_property
    def stretched(self) -> list[Stretched]:
        """Springs, dampers and ropes."""
        held = {force: end for _, _, piece in self._pieces() for force, end in piece.holds.items()}
        return list(stretched(self.motion, self.space.size, self._layer_of, held))

    def _layer_of(self, shape: Shape, radius: float) -> tuple[float, tuple[float, float]]:
        """Height of something of that radius that lies over what is at its two ends at the start, and these tops."""
        at = self.clock.moment(0)
        places = [placed(self.poses.body(b, at), marker) for b, marker in zip(shape.bodies, shape.markers, strict=True)]
        tops = []
        for body, place in zip(shape.bodies, places, strict=True):
            beside = [top for top in self._tops(body) if body != "ground"] or [float(self.space.all[:, 2].min())]
            tops.append(max(self.space.tops_at(body, *place, at) or beside))
        return max(tops) + 1.25 * radius, (tops[0], tops[1])

    @cached_property
    def _arrow_heights(self) -> list[float]:
        """Of each arrow: on the highest piece where it begins at the start; else over all its bodies."""
        start = self.clock.moment(0)
        heights = []
        for vector in self.arrows.vectors:
            x, y = (float(value) for value in vector.place[0])
            tops = [top for body in vector.bodies for top in self.space.tops_at(body, x, y, start)]
            tops = tops or [top for body in vector.bodies for top in self._tops(body)]
            heights.append(max(tops, default=float(self.space.moving[:, 2].max())) + TRAIL_GAP)
        return heights

    @cached_property
    def _filmed(self) -> Array:
        """What the camera holds: everything, and the tips of all arrows."""
        frames = range(0, self.clock.frames, max(1, self.clock.frames // 60))
        moments = [self.clock.moment(frame) for frame in frames]
        paths = [path for one in self.stretched for at in moments for path in one.paths(self.poses, at)]
        return np.concatenate([self.space.all, *self.arrows.tips(self._arrow_heights), *map(np.asarray, paths)])

    def _writing(self) -> Writing:
        camera = self.camera(0)
        _, _, distance = self._stand
        shown = np.concatenate([self.space.moving, *self.arrows.tips(self._arrow_heights)])
        return Writing(
            legend=self.arrows.legend(2 * half_width(self.shot.camera.lens) * distance),
            corner=writing.emptiest(camera, shown, self.space.standing),
            title=writing.title(self.motion, self.shot),
            rate=writing.rate(self.clock, self.shot),
        )

    def camera(self, frame: int) -> CameraPose:
        """The camera at a frame: it stands still, or swings about the middle once in each showing of the motion."""
        shot = self.shot.camera
        elevation, azimuth = math.radians(shot.elevation), math.radians(shot.azimuth)
        swing = math.radians(shot.orbit)
        phase = math.tau * self.clock.phase(frame)
        position, target, distance = self._stand
        if swing:
            azimuth += swing * math.sin(phase)
            position = target - camera_axes(azimuth, elevation)[2] * distance
        forward = camera_axes(azimuth, elevation)[2]
        depths = (self.space.moving - position) @ forward
        focus, fstop = depth_of_field(float(depths.min()), float(depths.max()), shot.lens, shot.blur)
        return CameraPose(
            position=_point(position), azimuth=azimuth, elevation=elevation, lens=shot.lens, focus=focus, fstop=fstop
        )

    @cached_property
    def _stand(self) -> tuple[Array, Array, float]:
        """Camera position, the point it looks at, and their distance."""
        shot = self.shot.camera
        elevation, azimuth = math.radians(shot.elevation), math.radians(shot.azimuth)
        position, distance = fit(self._filmed, azimuth, elevation, shot.lens, shot.margin)
        target = position + camera_axes(azimuth, elevation)[2] * distance
        if shot.orbit:
            swing = azimuth + math.radians(shot.orbit) * np.linspace(-1, 1, 9)
            distance = orbit(self._filmed, target, swing, elevation, shot.lens, shot.margin)
        return position, target, distance

    def _pieces(self) -> list[tuple[str, str, Piece]]:
        return [(b, n, p) for b, solids in self.parts.bodies.items() for n, p in solids.pieces.items()]

    def _surface(self, body: str, name: str, piece: Piece) -> SurfaceSpec:
        chosen = self.shot.materials.get(f"{body}/{name}", self.shot.materials.get(body, piece.material))
        if isinstance(chosen, Surface):
            return SurfaceSpec(colour=chosen.colour, finish=chosen.finish, roughness=chosen.roughness)
        if chosen not in MATERIALS:
            raise UserError(
                f"{self.motion.mechanism}: piece {body}/{name} is of '{chosen}'; known: {', '.join(MATERIALS)}"
            )
        material = MATERIALS[chosen]
        return SurfaceSpec(colour=material.colour, finish=material.finish, roughness=material.roughness)

    def _trail_z(self, trail: Trail) -> float:
        if trail.z is not None:
            return trail.z
        body = self.motion.points[trail.point].body
        tops = self._tops(body) or [top for other in self.motion.bodies for top in self._tops(other)]
        return max(tops, default=0.0) + TRAIL_GAP

    def _tops(self, body: str) -> list[float]:
        """Heights of all pieces of a body (m)."""
        solids = self.parts.bodies.get(body)
        return [piece.z_range[1] for piece in solids.pieces.values()] if solids else []

    def _rings(self, trail: Trail) -> int:
        """So many that the tube strays from the point's way by no more than a part of its own radius.

        Between two moments h apart a chord strays by a h^2 / 8 from a way with acceleration a.
        """
        if trail.point not in self._ring_counts:
            point = self.motion.points[trail.point]
            bend = float(np.quantile(np.hypot(point.ax, point.ay), BENT))
            stray = TRAIL_STRAY * trail.radius * self.space.size
            length = trail.tail * (self.clock.end - self.clock.start) / self.clock.turns
            wanted = math.ceil(length * math.sqrt(bend / (8 * stray)))
            self._ring_counts[trail.point] = min(max(TRAIL_RINGS, wanted), MOST_RINGS)
        return self._ring_counts[trail.point]

    def _path(self, trail: Trail, frame: int) -> list[Point]:
        """Where the point was, from now back to the end of the tail; where an impact turned it is among the places."""
        times = self.clock.trail_times(frame, trail.tail, self._rings(trail))
        for event in self.motion.events:
            if times[-1] < event.time < times[0]:
                times[int(np.abs(times - event.time).argmin())] = event.time
        z = self._trail_z(trail)
        return [(float(x), float(y), z) for x, y in self.poses.point(trail.point, times)]

    def _label_place(self, name: str, frame: int) -> Point:
        """Just above the highest piece that its joint or point goes through."""
        at = self.clock.moment(frame)
        if name in self.motion.points:
            x, y = (float(value) for value in self.poses.point(name, np.array([at.time]))[0])
            bodies = (self.motion.points[name].body,)
        else:
            x, y = self.poses.joint(name, at)
            bodies = self.motion.joints[name].bodies
        tops = [top for body in bodies for top in self.space.tops_at(body, x, y, at)]
        return x, y, max(tops, default=float(self.space.moving[:, 2].max())) + LABEL_GAP * self.space.size

    def _refuse_mismatch(self) -> None:
        """The solids' bodies are the motion's; only the ground has no motion. Files are those parts.json describes."""
        name = self.motion.mechanism
        if self.parts.mechanism != name:
            raise UserError(f"parts.json is of {self.parts.mechanism}, data.json of {name}; make both again")
        unknown = [body for body in self.parts.bodies if body not in self.motion.bodies and body != "ground"]
        if unknown:
            raise UserError(
                f"{name}: parts.json has solids for {', '.join(unknown)}, which do not move in data.json; "
                f"it has: {', '.join(self.motion.bodies)}"
            )
        if not self._pieces():
            raise UserError(f"{name}: parts.json has no solids, so there is nothing to see; make the parts again")
        for _, _, piece in self._pieces():
            if file_hash(self.folder / piece.stl) != piece.stl_sha256:
                raise UserError(f"{name}: {piece.stl} is not the file parts.json describes; make the parts again")


def _point(vector: Array) -> Point:
    x, y, z = (float(value) for value in vector)
    return x, y, z
