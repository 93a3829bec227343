"""Close shots: a detail, and a section."""

from __future__ import annotations

import math

import numpy as np

from render.film.camera import angles, point
from render.film.film import Film
from render.film.framing import half_field, in_studio
from render.film.heights import tops as tops_of
from render.film.poses import Moment
from render.film.story.frame import Caption, Over, Picture, Shot, shown_in
from render.film.story.ramps import Ramp, eased
from render.film.story.scenery import Scenery, Stand, between, focused, raised
from render.film.story.words import plain
from render.insights.meeting import happening, meets, place_of
from shared.contract import JointMotion
from shared.contract.shot import Section
from shared.stage.errors import UserError

# A close look along one joint with a shallow depth, while the machine moves slowly.

MOVES, LEAST, AFTER, READ = 3.8, 2.6, 0.2, 24.0
"""Seconds of the move, those that the shot takes at least for a long caption, and those after the move; letters of a
caption that are read in a second."""
LENS, WIDE = 90.0, 0.36
"""mm, and the width of what is seen, in sizes of the machine."""
SLOWER = 0.4
"""The rate beside that of the loop."""
EVENT = 0.6
"""Part of the move after which most happens."""
ROPES = ("cord", "band")
"""Looks of joints at which little is to be seen."""
NEAR = 0.1
"""Way of a joint that stays, in sizes of the machine."""
FOLLOWED = 0.85
"""Part of the joint's way that the camera goes."""
LYING, STANDING = ((-34.0, 34.0), (14.0, 44.0)), ((-40.0, 16.0), (6.0, 26.0))
"""Azimuth and elevation (degrees) at the start and at the end of the move."""


def macro(scenery: Scenery) -> Shot | None:
    """Return the macro, in which most happens after EVENT of its move; None for a machine without joints."""
    name = busiest_joint(scenery)
    if name is None:
        return None
    clock, move = scenery.film.clock, scenery.moving(MOVES)
    rate = SLOWER * clock.rate
    event = float(scenery.film.motion.time[int(happening(scenery.film.motion, name).argmax())])
    begin = event - rate * EVENT * move
    ramp = Ramp(
        begin if clock.repeats else max(clock.start, begin), ((move * 0.75, rate, rate), (move * 0.25, rate, 0.0))
    )
    stands, text = _stands(scenery), _caption(scenery, name)
    whole = scenery.whole(max(move + AFTER, min(1.0 + len(text) / READ, LEAST)))

    def picture(s: float) -> Picture:
        time = ramp.time_at(min(s, move))
        at = scenery.loop_frame(time)
        a, b = (_aimed(scenery, stand, _place(scenery, name, at, event)) for stand in stands)
        camera = focused(between(a, b, eased(s / move)), scenery.up, scenery.blur)
        return Picture(at=at, camera=camera, hidden="trails")

    def over(s: float) -> Over:
        shown = shown_in(s, 0.2, whole - 0.2)
        return scenery.going(ramp.time_at(s), ramp.shown_rate(s), strip=False, caption=text, caption_shown=shown)

    captions = (Caption(0.2, whole - 0.2, text),)
    return Shot("macro", scenery.say("macro"), whole, picture, over, ramp.time_at, captions)


def _busy(scenery: Scenery) -> float:
    """Return when what the story is about happens (s)."""
    return scenery.reasons[0].start if scenery.reasons else scenery.film.clock.start


def busiest_joint(scenery: Scenery, stays: bool = False) -> str | None:
    """Return the joint that is asked for, else the one where most happens.

    Where bodies meet comes before pins, above before below; a pin that stands comes last, and ropes only where nothing
    else is. One that ``stays`` is near its place all the time, if there is any.
    """
    joints = scenery.film.motion.joints
    if scenery.wishes.joint is not None:
        return scenery.wishes.joint
    joints = {name: joint for name, joint in joints.items() if joint.look not in ROPES} or joints
    if stays:
        joints = {name: joint for name, joint in joints.items() if _way(joint) < NEAR * scenery.across} or joints
        return max(joints, key=lambda name: float(happening(scenery.film.motion, name).max()), default=None)
    if not joints:
        return None
    tops = {name: _height(scenery, name) for name in joints}
    highest = max(tops.values())
    stack = highest - min(tops.values())

    def worth(name: str) -> tuple[bool, bool, bool, float]:
        joint = joints[name]
        on_top = tops[name] >= highest - 0.35 * stack - 1e-9
        moves = meets(joint) or _way(joint) > 0.02 * scenery.across
        return meets(joint), moves, on_top, float(happening(scenery.film.motion, name).max())

    return max(joints, key=worth)


def _way(joint: JointMotion) -> float:
    """Return how far a joint goes (m)."""
    return float(max(np.ptp(part) for part in place_of(joint)))


def _height(scenery: Scenery, name: str) -> float:
    """Return the highest piece of a moving body at a joint, at the start of the motion (m)."""
    film = scenery.film
    at = film.clock.moment(0)
    x, y = film.poses.joint(name, at)
    bodies = [body for body in film.motion.joints[name].bodies if body in film.motion.bodies]
    heights = [top for body in bodies for top in film.space.tops_at(body, x, y, at)]
    heights = heights or [top for body in bodies for top in tops_of(film.parts, body)]
    return max(heights, default=scenery.top)


def place_at(scenery: Scenery, name: str) -> tuple[float, float, float]:
    """Return where a joint is when most happens there (m, world)."""
    time = float(scenery.film.motion.time[int(happening(scenery.film.motion, name).argmax())])
    return _place(scenery, name, scenery.loop_frame(time), time)


def _place(scenery: Scenery, name: str, at: float, event: float) -> tuple[float, float, float]:
    """Return where the joint is (m, world) at a frame, for a camera that does not follow all of its way.

    Where bodies meet it waits for the ``event`` (s).
    """
    moment = scenery.film.clock.moment(at)
    joint = scenery.film.motion.joints[name]
    if meets(joint) and joint.acts is not None and not scenery.film.way(at).any():
        x, y = (float(np.interp(event, scenery.film.motion.time, part)) for part in place_of(joint))
        return x, y, _height(scenery, name)
    x, y = scenery.film.poses.joint(name, Moment(moment.time, 0))
    middle = np.array([np.mean(joint.x), np.mean(joint.y)])
    away = scenery.film.way(at).any()
    part = 1.0 if away else FOLLOWED
    x, y = middle + part * (np.array([x, y]) - middle)
    return float(x), float(y), _height(scenery, name)


def _stands(scenery: Scenery) -> tuple[Stand, Stand]:
    film = scenery.film
    lies = film.parts.mount.kind == "desk"
    azimuths, elevations = LYING if lies else STANDING
    base = angles(film.shot.camera, film.parts.mount, film.aspect)[0]
    size = min(scenery.across, film.size)
    distance = WIDE * size / (2 * half_field(LENS, max(film.aspect, 1.0))[0])
    first, last = (
        Stand((0.0, 0.0, 0.0), base + math.radians(a), math.radians(e), distance * part, LENS)
        for a, e, part in zip(azimuths, elevations, (1.0, 0.86), strict=True)
    )
    return first, last


def _aimed(scenery: Scenery, stand: Stand, place: tuple[float, float, float]) -> Stand:
    target = point(in_studio(np.array(place), scenery.up))
    return raised(Stand(target, stand.azimuth, stand.elevation, stand.distance, stand.lens), scenery.up, scenery.top)


def _caption(scenery: Scenery, name: str) -> str:
    """Return an insight that is neither the story's stop nor its motion, best of the joint; else the joint's name."""
    said = [each for each in (*scenery.reasons[:1], scenery.of_motion) if each is not None]
    reported = {each.template for each in said} | {abs(each.number) for each in said}
    every = [each for each in (*scenery.shows, *scenery.reasons) if scenery.fits(each)]
    new = [each for each in every if each.template not in reported and abs(each.number) not in reported]
    insight = next((each for each in new if name in each.joints), next(iter(new), None))
    return scenery.say("joint", name=plain(name)) if insight is None else scenery.sentence(insight)


# The section: the machine in motion as its shot cuts it open; the camera walks a little to the side of the cut.

SECTION_MOVES = 4.0
"""Seconds of the move."""
BEGIN, END = (-12.0, 4.0), (8.0, -2.0)
"""Azimuth and elevation (degrees) beside those of the cut film, from which its faces are seen; what is cut from the
left is seen the other way round."""


def section(scenery: Scenery) -> Shot | None:
    """Return the section; None for a shot that cuts nothing open.

    Raises UserError if the shot asks for it all the same.
    """
    if scenery.cut is None:
        if "section" in (scenery.wishes.shots or ()):
            raise UserError(
                f"{scenery.film.motion.mechanism}: shot.story.shots has a section, and shot.section cuts nothing open; "
                "give the shot one, such as section=0.4"
            )
        return None
    clock, move = scenery.film.clock, scenery.moving(SECTION_MOVES)
    begin = clock.start if clock.repeats else max(clock.start, _busy(scenery) - clock.rate * move / 2)
    ramp = Ramp(begin, ((0.75 * move, clock.rate, clock.rate), (0.25 * move, clock.rate, 0.0)))
    whole = scenery.whole(max(move + AFTER, LEAST))
    side, turn = _side(scenery), _turn(scenery, scenery.cut)
    first, last = (scenery.stand(turn + side * azimuth, high, strip=False) for azimuth, high in (BEGIN, END))

    def picture(s: float) -> Picture:
        stand = between(first, last, eased(s / move))
        return scenery.picture(stand, ramp.time_at(min(s, move)), hidden="trails", cut=True)

    text = scenery.say("cut_open")

    def over(s: float) -> Over:
        rate, shown = ramp.shown_rate(s), shown_in(s, 0.2, whole - 0.2)
        return scenery.going(ramp.time_at(s), rate, strip=False, caption=text, caption_shown=shown)

    captions = (Caption(0.2, whole - 0.2, text),)
    return Shot("section", scenery.say("section"), whole, picture, over, ramp.time_at, captions)


def _turn(scenery: Scenery, cut: Film) -> float:
    """Return degrees from the azimuth of the story to that of the film that is cut open, with its light."""
    here, there = (angles(film.shot.camera, film.parts.mount, film.aspect)[0] for film in (scenery.film, cut))
    return math.degrees(there - here)


def _side(scenery: Scenery) -> float:
    """Return 1 for a cut that is seen from the right, or the front; -1 from the left."""
    cut = scenery.cut.shot.section if scenery.cut is not None else 0.0
    return -1.0 if isinstance(cut, Section) and cut.left else 1.0
