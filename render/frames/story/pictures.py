"""The pictures of a story: states of its film with and without arrows, kept by what they show as all frames are."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import msgspec

from render.film.film import Film
from render.film.scene import Point, Scene, State, Writing
from render.film.story.frame import Picture
from render.frames.frames import Pictures

Around = tuple[Picture, Picture, Picture]


@dataclass
class StoryPictures(Pictures):
    """Pictures of one scene; picture k is the middle of ``rows[k]``, between those that its shutter sees."""

    rows: tuple[Around, ...] = ()
    what: str = ""
    """What they are, for people."""

    @cached_property
    def _scene(self) -> Scene:
        return msgspec.structs.replace(self.film.scene, writing=Writing())

    @property
    def shown(self) -> Scene:
        """The scene of the film, without what is written over it: stories have their own words."""
        return self._scene

    def around(self, frame: int) -> tuple[int, int, int]:
        """Numbers of states: those of neighbours are negative, so that each picture has its own."""
        return -2 * frame - 1, frame, -2 * frame - 2

    def state(self, frame: int) -> State:
        """The state of picture ``frame``; negative ones are neighbours of :meth:`around`."""
        if frame not in self._states:
            row, side = (frame, 1) if frame >= 0 else ((-frame - 1) // 2, 0 if frame % 2 else 2)
            self._states[frame] = _state(self.film, self.rows[row][side])
        return self._states[frame]


def _state(film: Film, picture: Picture) -> State:
    state = film.state(picture.at, picture.camera)
    grown = picture.grown if picture.forces else 0.0
    return msgspec.structs.replace(
        state,
        arrows=[(tail, _along(tail, tip, grown)) for tail, tip in state.arrows],
        arcs=[(middle, sweep * grown) for middle, sweep in state.arcs],
        number="",
        lifts=dict(picture.lifts),
        hidden=picture.hidden,
    )


def _along(tail: Point, tip: Point, part: float) -> Point:
    x, y, z = (a + part * (b - a) for a, b in zip(tail, tip, strict=True))
    return x, y, z
