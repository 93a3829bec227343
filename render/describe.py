"""From the files (data.json, parts.json, shot.json) to a scene in plain data, and to the state of each frame."""

from __future__ import annotations

import math
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render.framing import CameraPose, depth_of_field, fit, orbit
from render.framing import axes as camera_axes
from render.poses import Poses, moment
from render.scene import LabelSpec, PieceSpec, Point, Scene, State, StudioSpec, SurfaceSpec, TrailSpec
from render.swept import SweptSpace
from shared.contract import Motion, Parts, Piece
from shared.errors import UserError
from shared.files import file_hash
from shared.materials import MATERIALS
from shared.shot import Names, Shot, Surface, Trail, refuse_unknown

Array = NDArray[np.float64]
TRAIL_RINGS = 160
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
        refuse_unknown(shot, Names.of(motion, parts))
        self._refuse_mismatch()
        paths = {trail.point: self._trail_z(trail) for trail in self.trails}
        self.space = SweptSpace(self.poses, parts, folder, paths)

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
                TrailSpec(name=t.point, colour=t.colour, radius=t.radius * self.space.size, rings=TRAIL_RINGS)
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
        )

    def state(self, frame: int) -> State:
        """What frame ``frame`` shows; frames before 0 or after the first turn go on with the loop."""
        at = moment(self.motion, frame, self.shot.frames_per_turn)
        return State(
            bodies={name: self.poses.body(name, at) for name in self.parts.bodies},
            trails=[self._path(trail, frame) for trail in self.trails],
            labels=[self._label_place(label.at, frame) for label in self.shot.labels],
            camera=self.camera(frame),
        )

    def camera(self, frame: int) -> CameraPose:
        """The camera at a frame: it stands still, or swings about the middle once a turn."""
        shot = self.shot.camera
        elevation, azimuth = math.radians(shot.elevation), math.radians(shot.azimuth)
        swing = math.radians(shot.orbit)
        phase = math.tau * (frame % self.shot.frames_per_turn) / self.shot.frames_per_turn
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
        position, distance = fit(self.space.all, azimuth, elevation, shot.lens, shot.margin)
        target = position + camera_axes(azimuth, elevation)[2] * distance
        if shot.orbit:
            swing = azimuth + math.radians(shot.orbit) * np.linspace(-1, 1, 9)
            distance = orbit(self.space.all, target, swing, elevation, shot.lens, shot.margin)
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
        solids = self.parts.bodies.get(body)
        tops = [piece.z_range[1] for piece in solids.pieces.values()] if solids else []
        return max(tops, default=0.0) + TRAIL_GAP

    def _path(self, trail: Trail, frame: int) -> list[Point]:
        """Where the point was, from now back to the end of the tail."""
        count = self.shot.frames_per_turn
        phase = (frame % count) / count - trail.tail * np.linspace(0, 1, TRAIL_RINGS)
        start, end = self.motion.time[0], self.motion.time[-1]
        wrapped = phase - np.floor(phase)
        if self.motion.period is None:
            times = start + (end - start) * (1 - np.abs(1 - 2 * wrapped))
        else:
            times = start + self.motion.period * wrapped
        z = self._trail_z(trail)
        return [(float(x), float(y), z) for x, y in self.poses.point(trail.point, times)]

    def _label_place(self, name: str, frame: int) -> Point:
        """Just above the highest piece that its joint or point goes through."""
        at = moment(self.motion, frame, self.shot.frames_per_turn)
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
