"""The scenery of a story: the film, its cameras and its bounds."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film.camera import Subject, angles, point
from render.film.composing import View, held, near_miss, shown_area
from render.film.film import Film
from render.film.framing import REFERENCE_WIDTH, SENSOR, CameraPose, axes, depth_of_field, in_studio, in_world
from render.film.pieces import Lift, exploded
from render.film.scene import Hidden
from render.film.story import frame
from render.film.story.frame import LONGEST, Over, Picture
from render.film.story.story import Curve
from render.film.story.words import rate_words
from render.insights import Insight
from shared.contract.parts import Vector
from shared.contract.shot import Story as Wishes

# Stands of a story's cameras, and the eased paths between them.
#
# A stand counts in the axes of the studio; what is followed moves it. Cameras stay above all that moves: along the
# normal of the plane nothing is as high as they are, so none ever goes through a part.

Array = NDArray[np.float64]
OVER = 0.06
"""A camera is higher above all parts than this, in its distances."""


@dataclass(frozen=True)
class Stand:
    """Where a camera looks at, from which side (rad) and how far away (m)."""

    target: tuple[float, float, float]
    azimuth: float
    elevation: float
    distance: float
    lens: float

    @property
    def position(self) -> Array:
        """(3,) in the axes of the studio."""
        return np.array(self.target) - axes(self.azimuth, self.elevation)[2] * self.distance


def stand(subject: Subject, up: Vector, view: View) -> Stand:
    """Return the nearest stand from which a camera holds its subject, as films of one shot do."""
    few, around, drawn = (in_studio(points, up) for points in (subject.few, subject.around, subject.drawn))
    things = [in_studio(thing, up) for thing in subject.things]
    position, distance = view.stand(held(view, few, around, drawn, few, things))
    target = position + axes(view.azimuth, view.elevation)[2] * distance
    return Stand(point(target), view.azimuth, view.elevation, distance, view.lens)


def between(a: Stand, b: Stand, part: float) -> Stand:
    """Return a stand on the path from ``a`` to ``b``, 0 .. 1; distances change by equal factors."""
    if a == b:
        return a
    target = (1 - part) * np.array(a.target) + part * np.array(b.target)
    azimuth, elevation, lens = (
        (1 - part) * x + part * y for x, y in ((a.azimuth, b.azimuth), (a.elevation, b.elevation), (a.lens, b.lens))
    )
    distance = a.distance ** (1 - part) * b.distance**part
    return Stand(point(target), azimuth, elevation, distance, lens)


def raised(stand: Stand, up: Vector, top: float) -> Stand:
    """Return the stand, so far back that the camera is above ``top`` (m) along the normal of the plane."""
    normal = in_studio(np.array([0.0, 0.0, 1.0]), up)
    back = -float(axes(stand.azimuth, stand.elevation)[2] @ normal)
    height = float(np.array(stand.target) @ normal)
    if back < 1e-3:
        return stand
    needed = (top - height) / (back - OVER) if back > OVER else 0.0
    return stand if stand.distance >= needed else at_distance(stand, needed)


def at_distance(stand: Stand, distance: float) -> Stand:
    """Return the stand at another distance (m) from what it looks at."""
    return Stand(stand.target, stand.azimuth, stand.elevation, distance, stand.lens)


def posed(stand: Stand, up: Vector, sharp: Array, blur: float, by: Array | None = None) -> CameraPose:
    """Return a camera at a stand, moved ``by`` (3,) m of the world, with that blur.

    It blurs the nearest and farthest of points ``sharp`` (n, 3) of the world by so many pixels of a picture 1280 wide.
    """
    position = stand.position
    depths = (in_studio(sharp, up) - position) @ axes(stand.azimuth, stand.elevation)[2]
    near = max(float(depths.min()), 0.05 * stand.distance)
    focus, fstop = depth_of_field(near, max(float(depths.max()), 1.001 * near), stand.lens, blur)
    return _camera(stand, up, by, focus, fstop)


def focused(stand: Stand, up: Vector, blur: float) -> CameraPose:
    """Return a camera with a shallow depth.

    Its target is sharp, and a fifth of the distance behind it things blur by ``blur`` pixels.
    """
    focus, away = stand.distance, 1.2 * stand.distance
    disc, length = blur * SENSOR / REFERENCE_WIDTH / 1000, stand.lens / 1000
    fstop = length**2 * (away - focus) / (disc * away * (focus - length)) if blur > 0 and focus > length else 0.0
    return _camera(stand, up, None, focus, fstop)


def _camera(stand: Stand, up: Vector, by: Array | None, focus: float, fstop: float) -> CameraPose:
    position = in_world(stand.position, up) + (0.0 if by is None else by)
    return CameraPose(
        position=point(np.round(position, 9)), azimuth=stand.azimuth, elevation=stand.elevation, lens=stand.lens,
        focus=focus, fstop=fstop, up=up,
    )  # fmt: skip


def turned(stand: Stand, azimuth: float, elevation: float = 0.0, nearer: float = 1.0) -> Stand:
    """Return the stand turned about what it looks at by so many degrees, at ``nearer`` times its distance."""
    return Stand(
        stand.target,
        stand.azimuth + math.radians(azimuth),
        min(stand.elevation + math.radians(elevation), math.radians(85)),
        stand.distance * nearer,
        stand.lens,
    )


# Scenery that the shots of a story share: the film with and without arrows, its stands, its words.

WIDE = 1.5
"""Aspect of a picture from which on there may be room for the strip beside the machine."""
LARGER = 1.08
"""The strip stands there where that makes the machine so many times larger."""
MARGIN = 0.05
"""Empty part of the picture at each side at most: strip and captions stand apart already."""


@dataclass
class Scenery:
    """Everything that a shot may ask for.

    ``forces`` is the same film with arrows; None where nothing has any.
    """

    film: Film
    forces: Film | None
    wishes: Wishes
    reasons: Sequence[Insight]
    """Stops, the first one first."""
    curves: Sequence[Curve]
    say: Callable[..., str]
    step: int
    """Frames for which a picture that moves stands: 2 is on twos."""
    blur: float
    """Lens blur of a macro, in pixels of a picture 1280 wide; 0 is a pinhole."""
    cut: Film | None = None
    """The same film cut open; None where the shot has no section."""
    shows: Sequence[Insight] = ()
    """All that the motion shows, the most telling first."""
    scale: float = 1.0
    """Part of the seconds in which pictures move; what is cut is held instead."""
    turning: bool = True
    """True if the camera moves while the machine is shown; else later turns find their pictures made."""
    kept: dict[tuple[float, float, bool, bool], Stand] = field(default_factory=dict)
    """Stands that were looked for; they are the same for every scale."""

    @property
    def up(self) -> tuple[float, float, float]:
        """Direction that points up in the world."""
        return self.film.parts.mount.up

    @property
    def rate(self) -> float:
        """Seconds of the motion in a second of the loop film."""
        return self.film.clock.rate

    @property
    def fps(self) -> int:
        """Frames a second."""
        return self.film.shot.fps

    @cached_property
    def lifts(self) -> list[Lift]:
        """How the machine comes apart."""
        return exploded(self.film.parts, self.across)

    @cached_property
    def across(self) -> float:
        """Size (m) of the machine in the plane of its motion, at its start."""
        points = np.concatenate([self.piece(lift) for lift in self._pieces])
        return float(np.linalg.norm(np.ptp(points[:, :2], axis=0)))

    @cached_property
    def _pieces(self) -> list[Lift]:
        return exploded(self.film.parts, 1.0)

    def piece(self, lift: Lift, apart: float = 0.0) -> Array:
        """Return points (n, 3) around a piece at the start, lifted by a part of its distance (m)."""
        names = list(self.film.parts.bodies[lift.body].pieces)
        outline = self.film.space.outlines(lift.body)[names.index(lift.piece)]
        x, y, theta = self.film.poses.body(lift.body, self.film.clock.moment(0))
        c, s = np.cos(theta), np.sin(theta)
        turned = outline @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        return turned + np.array([x, y, 0.0]) + apart * lift.distance * np.array(lift.axis)

    def loop_frame(self, time: float) -> float:
        """Return the frame of the loop that shows a time of the motion (s), also beyond a period.

        It may lie between two frames. Times that are nearer than a millionth of a frame are one, so that a second turn
        finds its pictures made.
        """
        clock = self.film.clock
        frame = (time - clock.start) / (clock.end - clock.start) * clock.moving
        if clock.repeats:
            frame = round(frame % clock.frames, 6)
            return 0.0 if frame == clock.frames else frame
        return round(min(max(frame, 0.0), float(clock.moving)), 6)

    @cached_property
    def top(self) -> float:
        """The highest point along the normal of the plane (m)."""
        return float(self.film.space.all[:, 2].max())

    def stand(self, azimuth: float = 0.0, elevation: float = 0.0, strip: bool = True, arrows: bool = False) -> Stand:
        """Return the stand that holds the machine, with room for words.

        It is turned by so many degrees from that of the shot.
        """
        asked = azimuth, elevation, strip, arrows
        if asked not in self.kept:
            self.kept[asked] = self._stand(*asked)
        return self.kept[asked]

    def hold(self, stand: Stand) -> None:
        """Have the stand that is asked for without any words be this one."""
        self.kept[0.0, 0.0, True, False] = stand

    @cached_property
    def at_side(self) -> bool:
        """True if the strip stands beside the machine, as is better for one that is tall in a wide picture."""
        if not self.curves or self.film.aspect < WIDE:
            return False
        under, beside = (self._held(0.0, 0.0, True, False, side) for side in (False, True))
        return LARGER * beside.distance < under.distance

    def _stand(self, azimuth: float, elevation: float, strip: bool, arrows: bool) -> Stand:
        strip = strip and bool(self.curves)
        return self._held(azimuth, elevation, strip, arrows, strip and self.at_side)

    def _held(self, azimuth: float, elevation: float, strip: bool, arrows: bool, side: bool) -> Stand:
        """Return the stand with room for a strip under the machine, or at its ``side``."""
        film = self.forces if arrows and self.forces is not None else self.film
        at = angles(film.shot.camera, film.parts.mount, film.aspect)
        turned = at[0] + np.radians(azimuth), min(at[1] + np.radians(elevation), np.radians(85))
        empty = frame.above(film.aspect), frame.below(film.aspect, strip and not side)
        camera, aside = film.shot.camera, frame.side_width(film.aspect) if side else 0.0
        margin = min(camera.margin, MARGIN)
        view = View(float(turned[0]), float(turned[1]), camera.lens, margin, empty, film.aspect, aside)
        return raised(stand(film.subject, self.up, view), self.up, self.top)

    def share(self, stand: Stand) -> float:
        """Return the part of the picture's area that the room of what moves takes from a stand."""
        return shown_area(self._view(stand), stand.position, in_studio(self.film.subject.few, self.up))

    def misses(self, stand: Stand) -> bool:
        """Return True if the plate or the stand is cut by a sliver from there."""
        things = [in_studio(thing, self.up) for thing in self.film.subject.things]
        return any(near_miss(self._view(stand), stand.position, thing) > 0.0 for thing in things)

    def _view(self, stand: Stand) -> View:
        return View(stand.azimuth, stand.elevation, stand.lens, 0.0, aspect=self.film.aspect)

    def camera(self, stand: Stand, at: float) -> CameraPose:
        """Return a camera at a stand, which goes along with what is followed."""
        sharp = self.film.subject.few
        return posed(stand, self.up, sharp, self.film.shot.camera.blur, self.film.way(at))

    def picture(
        self,
        stand: Stand,
        time: float,
        forces: bool = False,
        grown: float = 0.0,
        hidden: Hidden = "",
        cut: bool = False,
    ) -> Picture:
        """Return the machine at a time of the motion (s), from a stand."""
        at = self.loop_frame(time)
        forces = forces and self.forces is not None
        return Picture(
            at=at,
            camera=self.camera(stand, at),
            forces=forces,
            grown=grown if forces else 0.0,
            hidden=hidden,
            cut=cut,
        )

    def sentence(self, what: Insight) -> str:
        """Return an insight as a caption in the language of the story."""
        return what.sentence(self.wishes.language)

    def fits(self, what: Insight) -> bool:
        """Return True if the sentence of an insight is short enough for a caption."""
        return len(self.sentence(what)) <= LONGEST * max(1.0, self.film.aspect)

    @property
    def of_motion(self) -> Insight | None:
        """The most telling insight into what the machine does as long as it runs; None without any."""
        stop = self.reasons[0].template if self.reasons else ""
        lasting = [each for each in self.shows if each.end > each.start] or list(self.shows)
        return next((each for each in lasting if each.template != stop and self.fits(each)), None)

    def moving(self, seconds: float) -> float:
        """Return seconds of a move, as far as the budget of pictures lets it take them."""
        return self.whole(max(seconds * self.scale, 3 * self.step / self.fps))

    def whole(self, seconds: float) -> float:
        """Return the nearest seconds that are whole steps of pictures, at least one."""
        each = self.step / self.fps
        return each * max(1, round(seconds / each))

    def going(self, time: float, rate: float | None, strip: bool = True, **more: object) -> Over:
        """Return the overlay of a moving picture: the rate of time if it is written, and the strip."""
        words = "" if rate is None else rate_words(rate, self.say)
        over = Over(rate=words, strip=1.0 if strip and self.curves else 0.0, now=time)
        return msgspec.structs.replace(over, **more)
