"""The telling of a story: its pictures, shots and words for one mechanism."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import msgspec
import numpy as np

from render.film import composing
from render.film.arrows import Arcs, Arrows
from render.film.camera import angles
from render.film.film import Film
from render.film.inputs import refuse_missing
from render.film.scene import Point, Scene, State, Writing
from render.film.section import seen_from
from render.film.story.frame import Picture
from render.film.story.planned import planned
from render.film.story.story import Story
from render.film.story.words import plain
from render.film.vectors import rounding
from render.frames.frames import Pictures
from render.frames.story.drawing import BETWEEN, Drawing, caption_lines
from render.frames.story.strip import Strip
from render.freshness import current_clearance
from render.insights import Insight, insights
from render.insights.loops import marks
from render.insights.stops import stops, words_of
from render.presets import Preset
from render.report import description
from render.report.facts import facts
from shared.contract import Motion, read_motion, read_parts
from shared.contract.geometry import with_rods
from shared.contract.shot import Shot, read_shot, shown
from shared.contract.shot import Story as Wishes
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.paths import Out

# The pictures of a story: states of its film with and without arrows, kept by what they show as all frames are.

Around = tuple[Picture, Picture, Picture]
UNDER_RATE = 0.125
"""Height at which notes on parts that cannot be built stand, below the rate (the picture's shorter side)."""


@dataclass
class StoryPictures(Pictures):
    """Pictures of one scene; picture k is the middle of ``rows[k]``, between those that its shutter sees."""

    rows: tuple[Around, ...] = ()
    what: str = ""
    """Their name, for people."""

    @cached_property
    def _scene(self) -> Scene:
        scene, film = self.film.scene, self.film
        note = composing.note(film.parts.schematic, film.aspect, UNDER_RATE)
        return msgspec.structs.replace(scene, writing=Writing(lines=note, on_bright=scene.writing.on_bright))

    @property
    def shown(self) -> Scene:
        """The scene of the film with its note alone written over it: stories have their own words."""
        return self._scene

    @property
    def count(self) -> int:
        """Different frames."""
        return len(self.rows)

    def around(self, frame: int) -> tuple[int, int, int]:
        """Return numbers of states: those of neighbours are negative, so that each picture has its own."""
        return -2 * frame - 1, frame, -2 * frame - 2

    def state(self, frame: int) -> State:
        """Return the state of picture ``frame``; negative ones are neighbours of :meth:`around`."""
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
        arcs=[(middle, sweep * grown, axis) for middle, sweep, axis in state.arcs],
        number="",
        lifts=dict(picture.lifts),
        hidden=picture.hidden,
    )


def _along(tail: Point, tip: Point, part: float) -> Point:
    x, y, z = (a + part * (b - a) for a, b in zip(tail, tip, strict=True))
    return x, y, z


# Reads the files of a machine and makes its story: the films it is rendered from, its shots, what is drawn over.

SHOWN = {"effort_peak": "forces", "speed": "velocities", "speed_peak": "velocities", "difference": "velocities"}
"""Quantities of arrows by the kind of reason; reactions else."""
FACTS = 4
"""Facts at the end, at most."""
MARKS = 8
"""Events in the strip, at most: more are a pattern of their own."""


@dataclass
class Telling:
    """A story with all that its film is made of."""

    film: Film
    forces: Film | None
    story: Story
    drawing: Drawing
    cut: Film | None = None

    def pictures(self, preset: Preset) -> list[StoryPictures]:
        """Return the different pictures of the story, in sets of one scene each."""
        rows: dict[Around, None] = dict.fromkeys(self.row(frame, preset) for frame in range(self.story.total))
        sets = []
        for forces, cut, film in ((False, False, self.film), (False, True, self.cut), (True, False, self.forces)):
            own = tuple(row for row in rows if (row[1].forces, row[1].cut) == (forces, cut))
            if film is not None and own:
                what = f"in the story, {'cut open' if cut else 'with arrows' if forces else 'without arrows'}"
                sets.append(StoryPictures(film, preset, rows=own, what=what))
        return sets

    def row(self, frame: int, preset: Preset) -> Around:
        """Return the pictures that Blender makes for a frame, between its neighbours where the shutter blurs them."""
        if preset.motion_blur:
            return self.story.around(frame)
        picture = self.story.picture(frame)
        return picture, picture, picture

    @cached_property
    def count(self) -> int:
        """Different pictures."""
        return len(self.story.pictures)

    def said(self) -> str:
        """Return shots and cost, for people."""
        loop = self.film.clock.frames
        shots = ", ".join(f"{placed.shot.name} {placed.shot.seconds:.1f} s" for placed in self.story.placed)
        return f"{duration(self.story.seconds)}: {shots}; {self.count} pictures, the loop film has {loop}"


def telling_of(
    out: Out, preset: Preset, show: str = "", loop: float = 0.0, shots: tuple[str, ...] | None = None
) -> Telling:
    """Return the story of a machine, of these ``shots`` alone if they are given.

    Raises UserError for what its shot asks of it and cannot be, with the remedy.
    """
    refuse_missing(out)
    shot, parts = read_shot(out.shot), read_parts(out.parts, out.name)
    if shots is not None:
        shot = msgspec.structs.replace(shot, story=Wishes(shots=shots, language=shot.story.language))
    motion = read_motion(out.motion, out.name)
    why = stops(motion)
    whole = with_rods(motion, parts)
    film = Film(whole, parts, shown_plain(shot), out.parts_folder, preset.aspect)
    chosen = _chosen(shot.story.event, why)
    arrows = _with_arrows(show or _shows(motion, chosen), film)
    if not show and arrows is not None and chosen is not None:
        arrows = _in_balance(arrows, chosen)
    cut = _cut_open(shot, film)
    story = planned(film, arrows, why, preset, loop, cut, insights(motion))
    clearance = current_clearance(out, parts, "film")
    drawing = _drawing(out, preset, film, story, facts(motion, parts, clearance))
    refuse_long(out.name, story, preset)
    return Telling(film, arrows, story, drawing, cut)


def shown_plain(shot: Shot) -> Shot:
    """Return the whole machine without arrows and without words over it: the story has its own."""
    return msgspec.structs.replace(shot, show=(), title=None, section=0.0)


def _chosen(event: str | None, why: list[Insight]) -> Insight | None:
    return next((reason for reason in why if event is None or event in words_of(reason)), None)


def _shows(motion: Motion, reason: Insight | None) -> str:
    """Return the quantities that arrows show."""
    if reason is None:
        return "velocities"
    show = SHOWN.get(reason.kind, "reactions")
    carries = any(np.any(joint.fx) or np.any(joint.fy) for joint in motion.joints.values())
    return show if show != "reactions" or carries else "velocities"


def _with_arrows(show: str, film: Film) -> Film | None:
    """Return the same film with arrows; None where none is ever seen."""
    made = Film(film.motion, film.parts, shown(film.shot, show), film.folder, film.aspect)
    return made if made.arrows.vectors or made.arcs.torques else None


def _in_balance(film: Film, reason: Insight) -> Film:
    """Return the film with the forces and torques on the body of the reason alone, as it feels them.

    The same film where arrows are no forces, or the reason names no body that moves.
    """
    motion = film.motion
    bodies = [body for body in reason.bodies if body in motion.bodies]
    for name in reason.joints:
        load = motion.drivers.get(name) or motion.forces.get(name)
        if load is not None:
            bodies += [action.body for action in load.actions if action.body in motion.bodies]
    if "velocities" in film.shot.show or not bodies:
        return film
    made = Film(motion, film.parts, shown(film.shot, "forces,reactions"), film.folder, film.aspect)
    own: dict[str, list[Any]] = {"vectors": [], "torques": []}
    for key, acting in (("vectors", made.arrows.vectors), ("torques", made.arcs.torques)):
        for each in acting:
            if bodies[0] in each.bodies:
                on = next((body for body in reversed(each.bodies) if body in motion.bodies), "")
                own[key].append(each if on == bodies[0] else replace(each, value=-each.value))
    straight = Arrows(made.poses.time, own["vectors"], made.size)
    least = rounding(own["vectors"], made.size)
    made.__dict__["arrows"], made.__dict__["arcs"] = straight, Arcs(made.poses.time, own["torques"], made.size, least)
    return made if straight.vectors or made.arcs.torques else film


def _cut_open(shot: Shot, film: Film) -> Film | None:
    """Return the same film as the shot cuts it open; None where it does not. Raises UserError for one that opens no
    piece.
    """
    if not shot.section:
        return None
    usual = math.degrees(angles(shot.camera, film.parts.mount, film.aspect)[0])
    camera = msgspec.structs.replace(shot.camera, azimuth=seen_from(shot.section, usual))
    opened = msgspec.structs.replace(film.shot, section=shot.section, camera=camera)
    made = Film(film.motion, film.parts, opened, film.folder, film.aspect)
    assert made.scene  # refused now, not after the first picture
    return made


def _drawing(out: Out, preset: Preset, film: Film, story: Story, known: list[str]) -> Drawing:
    words = out.name.replace("_", " ").replace("-", ": ")
    said = tuple(re.split(r"(?<=[.!?])\s+(?=[A-Z0-9])", " ".join(description(out.name).split("\n\n")[0].split())))
    said = tuple(sentence for sentence in said if sentence != "SI units.")
    line = plain(BETWEEN.join(known[1 : 1 + FACTS]))
    return Drawing(
        wide=preset.width, high=preset.height, name=words[:1].upper() + words[1:], said=said,
        facts=line[:1].upper() + line[1:], strip=strip_of(film, story, preset),
    )  # fmt: skip


def strip_of(film: Film, story: Story, preset: Preset) -> Strip | None:
    """Return the strip of a story; None where it has no curves."""
    if not story.curves:
        return None
    times = sorted({at for at, _ in marks(film.motion)})
    return Strip(
        curves=story.curves, marks=times if len(times) <= MARKS else (), start=film.clock.start, end=film.clock.end,
        repeats=film.clock.repeats, wide=preset.width, high=preset.height, side=story.at_side,
    )  # fmt: skip


def refuse_long(mechanism: str, story: Story, preset: Preset) -> None:
    """Raise UserError for the first caption that is too long for the frame."""
    for placed in story.placed:
        for caption in placed.shot.captions:
            try:
                caption_lines(caption.text, preset.width, preset.height)
            except ValueError as error:
                raise UserError(
                    f"{mechanism}: the caption of the shot '{placed.shot.name}' is too long for a picture of "
                    f"{preset.width}x{preset.height}: {error} of 2 ('{caption.text}'); write a shorter "
                    "shot.story.caption"
                ) from None
