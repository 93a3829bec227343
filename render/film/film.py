"""From the files (data.json, parts.json, shot.json) to a scene in plain data, and to the state of each frame."""

from __future__ import annotations

import math
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render.film.arrows import writing
from render.film.arrows.arcs import Arcs
from render.film.arrows.arrows import Arrows
from render.film.arrows.torques import rounding, torques
from render.film.arrows.vectors import vectors
from render.film.camera import FilmCamera, point
from render.film.clock import Clock
from render.film.framing import CameraPose
from render.film.heights import Heights, trail_heights
from render.film.pieces import piece_specs, refuse_mismatch
from render.film.poses import Poses
from render.film.rolling.rollers import Rollers
from render.film.scene import LabelSpec, Scene, State, StudioSpec, Writing
from render.film.swept import SweptSpace
from render.film.tubes.belts import Belt, belts
from render.film.tubes.spirals import Spiral, spirals
from render.film.tubes.stretched import Stretched, stretched
from render.film.tubes.trails import Trails, trails_of
from shared.contract import Held, Motion, Parts
from shared.contract.shot import Names, Shot, refuse_unknown

Array = NDArray[np.float64]
LOOKED = 60
"""Frames in which springs and ropes are looked at for the camera."""


class Film:
    """Everything the film shows, without a picture yet."""

    def __init__(self, motion: Motion, parts: Parts, shot: Shot, folder: Path) -> None:
        """``folder`` holds the STL files. Raises UserError if names, bodies or files do not fit together."""
        self.motion, self.parts, self.shot, self.folder = motion, parts, shot, folder
        self.poses = Poses(motion)
        self.clock = Clock(motion, shot)
        refuse_unknown(shot, Names.of(motion, parts))
        refuse_mismatch(motion, parts, folder)
        paths = trail_heights(motion, parts, trails_of(motion, shot))
        self.space = SweptSpace(self.poses, parts, folder, paths)
        self.trails = Trails(self.poses, self.clock, shot, paths, self.space.size)
        self.rollers = Rollers(self.poses, parts)
        self.heights = Heights(self.poses, parts, self.space, self.clock)
        self.number = writing.number(motion, shot)

    @cached_property
    def scene(self) -> Scene:
        """The scene in plain data."""
        size = self.space.size
        return Scene(
            mechanism=self.motion.mechanism,
            fps=self.shot.fps,
            pieces=piece_specs(self.parts, self.shot, self.folder),
            trails=self.trails.specs(),
            labels=[LabelSpec(text=s.text, size=s.size * size, colour=s.colour) for s in self.shot.labels],
            studio=StudioSpec(
                look=self.shot.look,
                centre=point(self.space.middle),
                radius=size / 2,
                floor=float(self.space.all[:, 2].min()),
                azimuth=math.radians(self.shot.camera.azimuth),
            ),
            tubes=[spec for one in self.drawn for spec in one.specs],
            arrows=self.arrows.specs(),
            arcs=self.arcs.specs(),
            writing=self._writing(),
        )

    def state(self, frame: int) -> State:
        """What frame ``frame`` shows; frames before 0 or after the first showing go on with the loop."""
        at = self.clock.moment(frame)
        arrows, arcs = self._arrow_heights
        return State(
            bodies={name: self.poses.body(name, at) for name in self.parts.bodies} | self.rollers.poses(at),
            trails=self.trails.paths(frame),
            labels=[self.heights.words(label, at) for label in self.shot.labels],
            camera=self.camera(frame),
            tubes=[path for one in self.drawn for path in one.paths(self.poses, at)],
            arrows=self.arrows.at(at.time, arrows),
            arcs=self.arcs.at(at.time, arcs),
            number=self.number(at.time),
        )

    def camera(self, frame: int) -> CameraPose:
        """Where the camera is at a frame."""
        return self._camera.pose(frame)

    @cached_property
    def arrows(self) -> Arrows:
        """The straight arrows that the shot shows."""
        return Arrows(self.poses.time, vectors(self.motion, self.shot.show), self.space.size)

    @cached_property
    def arcs(self) -> Arcs:
        """The curved ones."""
        forces = vectors(self.motion, ("forces", "reactions"))
        least = rounding(forces, self.space.size)
        return Arcs(self.poses.time, torques(self.motion, self.shot.show), self.space.size, least)

    @cached_property
    def drawn(self) -> list[Stretched | Spiral | Belt]:
        """All that is laid anew in every frame."""
        return [*self.stretched, *self.spirals, *self.belts]

    @cached_property
    def stretched(self) -> list[Stretched]:
        """Springs, dampers and ropes."""
        return list(stretched(self.motion, self.space.size, self.heights.spring, self._held))

    @cached_property
    def belts(self) -> list[Belt]:
        """Belts and chains."""
        return list(belts(self.motion, self._held))

    @cached_property
    def _held(self) -> dict[str, Held]:
        """By the names of forces and belts: where parts say that the film draws them."""
        pieces = [piece for body in self.parts.bodies.values() for piece in body.pieces.values()]
        return {name: end for piece in pieces for name, end in piece.holds.items()}

    @cached_property
    def spirals(self) -> list[Spiral]:
        """Torsion springs."""
        return list(spirals(self.motion, self.space.size, self.heights.site))

    @cached_property
    def _arrow_heights(self) -> tuple[list[float], list[float]]:
        """Of each straight and each curved arrow (m)."""
        straight, curved = (
            [self.heights.arrow(one.bodies, *(float(value) for value in one.place[0])) for one in ones]
            for ones in (self.arrows.vectors, self.arcs.torques)
        )
        return straight, curved

    @cached_property
    def _drawn(self) -> list[Array]:
        """Points (n, 3) around all arrows, over the whole motion (m)."""
        straight, curved = self._arrow_heights
        return [*self.arrows.tips(straight), *self.arcs.rims(curved)]

    @cached_property
    def _camera(self) -> FilmCamera:
        """It holds everything that is seen."""
        frames = range(0, self.clock.frames, max(1, self.clock.frames // LOOKED))
        moments = [self.clock.moment(frame) for frame in frames]
        paths = [path for one in self.drawn for at in moments for path in one.paths(self.poses, at)]
        filmed = np.concatenate([self.space.all, *self._drawn, *map(np.asarray, paths)])
        camera = FilmCamera(self.shot.camera, self.clock, filmed, self.space.moving)
        for above in writing.ABOVE:
            if self._is_readable(camera):
                break
            camera = FilmCamera(self.shot.camera, self.clock, filmed, self.space.moving, above)
        return camera

    def _is_readable(self, camera: FilmCamera) -> bool:
        """Whether nothing moves under the title, and some corner is free for a legend."""
        title = writing.extent(self._said) if self._said[0] else (0.0, 0.0)
        words = (0.0, 0.0, *title)
        rows = [*self.arrows.legend(camera.width), *self.arcs.legend()]
        places = writing.card(rows, title).values() if rows else ()
        frames = range(0, self.clock.frames, max(1, self.clock.frames // 8)) if self.shot.camera.orbit else range(1)
        poses = [camera.pose(frame) for frame in frames]
        moving = self._seen_moving
        if title[0] and any(writing.held(pose, moving, words) for pose in poses):
            return False
        return not places or any(not any(writing.held(pose, moving, place) for pose in poses) for place in places)

    @cached_property
    def _said(self) -> tuple[str, str, str]:
        """Title, number and rate at the start."""
        return (
            writing.title(self.motion, self.shot),
            self.number(0.0),
            writing.rate(self.clock, self.shot),
        )

    @cached_property
    def _seen_moving(self) -> Array:
        """Points (n, 3) of what moves, and around all arrows (m)."""
        return np.concatenate([self.space.moving, *self._drawn])

    def _writing(self) -> Writing:
        legend = [*self.arrows.legend(self._camera.width), *self.arcs.legend()]
        places = writing.card(legend, writing.extent(self._said))
        return Writing(
            legend=legend,
            corner=writing.emptiest(self.camera(0), self._seen_moving, self.space.standing, places),
            title=writing.title(self.motion, self.shot),
            rate=writing.rate(self.clock, self.shot),
        )
