"""A film in plain data: the scene and each frame's state from data.json, parts.json, shot.json."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film import arrows, composing
from render.film.arrows import Arcs, Arrows
from render.film.camera import FilmCamera, Subject, angles, point
from render.film.clock import Clock
from render.film.composing import Box
from render.film.framing import CameraPose, axes, in_studio
from render.film.heights import Heights, SweptSpace, trail_heights
from render.film.pieces import piece_specs, refuse_mismatch
from render.film.poses import Poses
from render.film.rollers import Rollers
from render.film.scene import Card, LabelSpec, LegendRow, LineSpec, Plane, Scene, State, StudioSpec, Writing
from render.film.section import between_bodies
from render.film.space import SpaceHeights, SpacePoses, coils, torques_in_space, vectors_in_space
from render.film.tubes.belts import Belt, belts
from render.film.tubes.cables import Cable, cables
from render.film.tubes.spirals import Spiral, spirals
from render.film.tubes.stretched import Stretched, stretched
from render.film.tubes.trails import Trails, trails_of
from render.film.vectors import Torque, Vector, rounding, torques, vectors
from render.looks import look_of
from render.presets import ASPECT
from shared.contract import AnyMotion, Held, Motion, Motion3, Parts
from shared.contract.shot import Names, Quantity, Shot, refuse_unknown

Array = NDArray[np.float64]
MANY = 20_000
"""Number of points of moving things that are looked for under words, about."""
LOOKED = 60
"""Frames in which springs and ropes are looked at for the camera."""


class Film:
    """Everything the film shows, without a picture yet."""

    def __init__(self, motion: AnyMotion, parts: Parts, shot: Shot, folder: Path, aspect: float = ASPECT) -> None:
        """Read the STL files in ``folder`` for pictures of that ``aspect``, width over height.

        Raises UserError if names, bodies or files do not fit together.
        """
        self.motion: Motion = cast(Motion, motion)
        """Motion that is shown; in space a Motion3, as :attr:`in_space` is: what both have is asked alike."""
        self.in_space = motion if isinstance(motion, Motion3) else None
        self.parts, self.shot, self.folder, self.aspect = parts, shot, folder, aspect
        self.poses: Any = SpacePoses(motion) if isinstance(motion, Motion3) else Poses(motion)
        """Poses | SpacePoses, of which a pose, a path and what is carried are asked alike."""
        self.clock = Clock(motion, shot)
        refuse_unknown(shot, Names.from_motion(motion, parts))
        refuse_mismatch(motion, parts, folder)
        trails = trails_of(motion, shot)
        paths = {t.point: 0.0 for t in trails} if isinstance(motion, Motion3) else trail_heights(motion, parts, trails)
        self.space = SweptSpace(self.poses, parts, folder, paths)
        self.trails = Trails(self.poses, self.clock, shot, paths, self.size)
        self.rollers = Rollers(self.poses, parts)
        self.heights: Any = (
            SpaceHeights(self.poses, parts.mount.up, self.space.size)
            if self.in_space
            else Heights(self.poses, parts, self.space, self.clock)
        )
        """Heights | SpaceHeights"""
        self.number = arrows.number(motion, shot)
        self.look = look_of(shot, motion, parts.mount, self.space.size)

    @cached_property
    def scene(self) -> Scene:
        """The scene in plain data."""
        return Scene(
            mechanism=self.motion.mechanism,
            fps=self.shot.fps,
            pieces=piece_specs(self.parts, self.shot, self.folder, self.in_space or self.motion),
            trails=self.trails.specs(self.look.dark),
            labels=[LabelSpec(text=s.text, size=s.size * self.size, colour=s.colour) for s in self.shot.labels],
            studio=self.studio,
            tubes=[msgspec.structs.replace(spec, cut=self.cut) for arrow in self.drawn for spec in arrow.specs],
            arrows=self.arrows.specs(),
            arcs=self.arcs.specs(),
            writing=self._writing(),
        )

    @cached_property
    def cut(self) -> tuple[Plane, ...]:
        """Planes of the world by which a section cuts springs, ropes and belts."""
        if self.in_space is not None or not self.drawn:
            return ()
        return between_bodies(self.parts, self.shot.section, self.folder, self.motion)

    @cached_property
    def studio(self) -> StudioSpec:
        """Studio around the machine."""
        up, azimuth = self.parts.mount.up, angles(self.shot.camera, self.parts.mount, self.aspect)[0]
        middle, points = in_studio(self.space.middle, up), in_studio(self.space.all, up)
        right, away = np.abs((points - middle) @ axes(azimuth, 0.0)[::2].T).max(axis=0)
        return StudioSpec(
            look=self.look,
            centre=point(middle),
            radius=self.space.size / 2,
            floor=float(points[:, 2].min()),
            azimuth=azimuth,
            reach=(float(right), float(away)),
            wall=float(points[:, 1].max()) if self.parts.mount.kind == "wall" else None,
            up=up,
        )

    def state(self, frame: float, camera: CameraPose | None = None) -> State:
        """Return the state that frame ``frame`` shows; frames outside the first showing go on with the loop.

        With a ``camera`` of its own, it may lie between two frames.
        """
        at = self.clock.moment(frame)
        arrows, arcs = self._arrow_heights
        return State(
            bodies={name: self.poses.pose(name, at) for name in self.parts.bodies} | self.rollers.poses(at),
            trails=self.trails.paths(frame),
            labels=[self.heights.words(label, at) for label in self.shot.labels],
            camera=camera or self.camera(int(frame)),
            tubes=[path for arrow in self.drawn for path in arrow.paths(self.poses, at)],
            arrows=self.arrows.ends_at(at.time, arrows),
            arcs=self.arcs.sweeps_at(at.time, arcs),
            number=self.number(at.time),
        )

    def camera(self, frame: int) -> CameraPose:
        """Return where the camera is at a frame."""
        return self._camera.pose(frame)

    def way(self, frame: float) -> Array:
        """Return how far (3,) what is followed has come at a frame, in the world (m); nothing where the camera
        stands.
        """
        if self._way is None:
            return np.zeros(3)
        at = np.arange(len(self._way))
        return np.array([np.interp(min(max(frame, 0.0), at[-1]), at, part) for part in self._way.T])

    @property
    def subject(self) -> Subject:
        """Subject of the film, in points; a subject that is followed has them as seen from its path."""
        return self._subject

    @cached_property
    def overview(self) -> CameraPose:
        """A camera at the start that holds the machine over the whole motion, also where the film follows it."""
        if self._way is None:
            return self.camera(0)
        subject = Subject(self.space.machine, self.space.around, np.zeros((0, 3)), self.space.machine)
        return FilmCamera(self.shot.camera, self.parts.mount, self.clock, subject, self.aspect).pose(0)

    @property
    def travel(self) -> Array | None:
        """Where the camera goes (frames, 3) in the world (m); None where it stays."""
        return self._way

    @cached_property
    def arrows(self) -> Arrows:
        """The straight arrows that the shot shows."""
        return Arrows(self.poses.time, vectors_of(self.in_space or self.motion, self.shot.show), self.size)

    @cached_property
    def arcs(self) -> Arcs:
        """The curved ones."""
        forces = vectors_of(self.in_space or self.motion, ("forces", "reactions"))
        least = rounding(forces, self.size)
        return Arcs(self.poses.time, torques_of(self.in_space or self.motion, self.shot.show), self.size, least)

    @cached_property
    def drawn(self) -> list[Any]:
        """All that is laid anew in every frame."""
        if self.in_space is not None:
            return list(coils(self.in_space, self.size))
        return [*self.stretched, *self.spirals, *self.belts, *self.cables]

    @cached_property
    def stretched(self) -> list[Stretched]:
        """Springs, dampers and ropes."""
        return list(stretched(self.motion, self.size, self.heights.spring, self._held))

    @cached_property
    def belts(self) -> list[Belt]:
        """Belts and chains."""
        return list(belts(self.motion, self._held))

    @cached_property
    def cables(self) -> list[Cable]:
        """Cables over pulleys."""
        return list(cables(self.motion, self.size, self.heights.spring, self._held))

    @cached_property
    def _held(self) -> dict[str, Held]:
        """By the names of forces and belts: where parts say that the film draws them."""
        pieces = [piece for body in self.parts.bodies.values() for piece in body.pieces.values()]
        return {name: end for piece in pieces for name, end in piece.holds.items()}

    @cached_property
    def spirals(self) -> list[Spiral]:
        """Torsion springs."""
        return list(spirals(self.motion, self.size, self.heights.site))

    @cached_property
    def _arrow_heights(self) -> tuple[list[float], list[float]]:
        """Heights of each straight and each curved arrow (m)."""
        straight, curved = (
            [self.heights.arrow(part.bodies, *(float(value) for value in part.place[0])) for part in ones]
            for ones in (self.arrows.vectors, self.arcs.torques)
        )
        return straight, curved

    @cached_property
    def size(self) -> float:
        """Return the diagonal (m) of the box around what is filmed.

        That is everything, or, of what is followed, what is seen of it.
        """
        if self._way is None:
            return self.space.size
        return float(np.linalg.norm(np.ptp(self._followed, axis=0)))

    @cached_property
    def _way(self) -> Array | None:
        """Where the camera goes (frames, 3) in the world (m), if it follows the machine."""
        clock, follow = self.clock, self.shot.camera.follow
        if follow is False:
            return None
        places = self._places
        if not places.shape[1] or not (follow or composing.travels(places, clock.repeats)):
            return None
        return composing.way(places, clock.frames, self.shot.fps, clock.repeats)

    @cached_property
    def _times(self) -> Array:
        """Times of the frames in which the motion goes on, and of its end where it is held (s)."""
        frames = range(min(self.clock.frames, self.clock.moving + 1))
        return np.array([self.clock.moment(frame).time for frame in frames])

    @cached_property
    def _places(self) -> Array:
        """Points (frames, n, 3) of what moves, while the motion goes on."""
        return self.space.places(self._times)

    @cached_property
    def _followed(self) -> Array:
        """The machine (n, 3) as seen from the way of the camera."""
        assert self._way is not None
        return (self._places - self._way[: len(self._times), None]).reshape(-1, 3)

    @cached_property
    def _tubes(self) -> Array:
        """Return points (n, 3) of springs, ropes and belts over the whole motion.

        They are as seen from the way of the camera.
        """
        frames = range(0, self.clock.frames, max(1, self.clock.frames // LOOKED))
        points = [np.zeros((0, 3))]
        for frame in frames:
            at, here = self.clock.moment(frame), 0.0 if self._way is None else self._way[frame]
            points += [np.asarray(path) - here for arrow in self.drawn for path in arrow.paths(self.poses, at)]
        return np.concatenate(points)

    @cached_property
    def _drawn(self) -> Array:
        """Points (n, 3) around all arrows, over the whole motion (m), as seen from the way of the camera."""
        straight, curved = self._arrow_heights
        way = None
        if self._way is not None:
            ways = self._way[: len(self._times)].T
            way = np.stack([np.interp(self.poses.time, self._times, way) for way in ways], axis=1)
        tips = [*self.arrows.tips(straight, way), *self.arcs.rims(curved, way)]
        return np.concatenate(tips) if tips else np.zeros((0, 3))

    @cached_property
    def _subject(self) -> Subject:
        """Return the subject of the film."""
        if self._way is None:
            machine = np.concatenate([self.space.machine, self._tubes])
            return Subject(machine, self.space.around, self._drawn, machine, things=self.space.things)
        machine = np.concatenate([self._followed, self._tubes])
        return Subject(machine, np.zeros((0, 3)), self._drawn, machine, self._way)

    @cached_property
    def _camera(self) -> FilmCamera:
        """It is as near as what is written over the picture lets it be."""
        camera = self._camera_with(0.0, 0.0)
        above = 0.0
        for above in composing.PARTS:
            camera = self._camera_with(above, 0.0)
            if composing.is_free(camera.looks(), self._seen_moving, self._over, self.aspect):
                break
        for below in composing.PARTS:
            camera = self._camera_with(above, below)
            if self._has_a_free_corner(camera):
                break
        return camera

    def _has_a_free_corner(self, camera: FilmCamera) -> bool:
        """Return True if nothing moves where the legend may be."""
        places = self._places_of(composing.cards(self._legend(camera), self._words, self.aspect)).values()
        looks, moving = camera.looks(), self._seen_moving
        return not places or any(composing.is_free(looks, moving, place, self.aspect) for place in places)

    def _camera_with(self, above: float, below: float) -> FilmCamera:
        empty = above, below
        return FilmCamera(self.shot.camera, self.parts.mount, self.clock, self._subject, self.aspect, empty)

    def _legend(self, camera: FilmCamera) -> list[LegendRow]:
        return [*self.arrows.legend(camera.width), *self.arcs.legend()]

    def _places_of(self, cards: Mapping[str, Card]) -> dict[str, Box]:
        return {corner: composing.in_picture(composing.around(card), self.aspect) for corner, card in cards.items()}

    @cached_property
    def _lines(self) -> list[LineSpec]:
        """Return the lines of text at the upper left; parts that are shown and not built are noted below."""
        numbers = sorted({self.number(float(time)) for time in self._times} - {""})
        title, rate = arrows.title(self.motion, self.shot), arrows.rate(self.clock, self.shot)
        lines = composing.lines(title, numbers, rate, self.aspect)
        lower = max((line.y + composing.LINE * line.size for line in lines), default=composing.EDGE)
        return [*lines, *composing.note(self.parts.schematic, self.aspect, lower)]

    @cached_property
    def _words(self) -> Box:
        return composing.box_of(self._lines)

    @cached_property
    def _over(self) -> Box:
        """Return the place of the words, in parts of the picture, that moving parts keep clear of.

        A rate alone is small.
        """
        box = self._words if self.shot.title is not None else composing.box_of([])
        return composing.in_picture(box, self.aspect)

    @cached_property
    def _seen_moving(self) -> Array:
        """Points (n, 3) of what moves, and around all arrows (m), as seen from the way of the camera."""
        machine = self._subject.machine
        return np.concatenate([machine[:: max(1, len(machine) // MANY)], self._drawn])

    def _writing(self) -> Writing:
        legend = self._legend(self._camera)
        cards = composing.cards(legend, self._words, self.aspect)
        card, looks = None, self._camera.looks()
        if cards:
            standing = self.space.standing if self._way is None else np.zeros((0, 3))
            places = self._places_of(cards)
            card = cards[composing.emptiest(looks, self._seen_moving, standing, places, self.aspect)]
        return Writing(lines=self._lines, legend=legend, card=card, on_bright=not self.look.dark)


def vectors_of(motion: AnyMotion, show: Sequence[Quantity]) -> list[Vector]:
    """Return all straight arrows that ``show`` asks for, in the plane or in space."""
    return vectors_in_space(motion, show) if isinstance(motion, Motion3) else vectors(motion, show)


def torques_of(motion: AnyMotion, show: Sequence[Quantity]) -> list[Torque]:
    """Return all curved arrows that ``show`` asks for, in the plane or in space."""
    return torques_in_space(motion, show) if isinstance(motion, Motion3) else torques(motion, show)
