"""shot.json: how a motion is filmed, as data only; ``Shot()`` alone gives a good film.

Metres and seconds; angles in degrees, because this is written by hand; colours linear RGB 0..1.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Literal, get_args

import msgspec

from shared.contract import AnyMotion, Parts
from shared.contract.materials import MATERIALS
from shared.contract.parts import Kind
from shared.stage import jsonfile
from shared.stage.errors import UserError, did_you_mean

Unit = Annotated[float, msgspec.Meta(ge=0, le=1)]
Positive = Annotated[float, msgspec.Meta(gt=0)]
Colour = tuple[Unit, Unit, Unit]


class _Strict(msgspec.Struct, forbid_unknown_fields=True, kw_only=True, frozen=True):
    """Struct that rejects unknown fields."""


LookName = Literal["studio", "cyclorama", "bench", "daylight", "road", "sand", "blueprint"]


class Camera(_Strict, frozen=True):
    """Camera of a shot.

    Its distance follows from the swept motion: all of it is in the frame and fills four fifths of its width or height;
    base and stand are in it as far as that leaves room, trails as it happens.
    """

    azimuth: Annotated[float, msgspec.Meta(ge=-180, le=180)] | None = None
    """Degrees about what points up; 0 looks along +y at what lies on a desk, and against z at what stands; positive
    walks to the right. Null is -16 of what lies, -24 of what stands, and more in a picture that is taller than wide."""
    elevation: Annotated[float, msgspec.Meta(ge=5, le=89)] | None = None
    """Degrees above the floor; null is 42 of what lies, and 10, at eye level, of what stands, and more in a picture
    that is taller than wide."""
    lens: Annotated[float, msgspec.Meta(ge=20, le=200)] = 55.0
    """Focal length in mm on a 36 mm wide sensor."""
    margin: Annotated[float, msgspec.Meta(ge=0, le=0.4)] = 0.09
    """Empty part of the frame's width (and height) left on each side of the swept motion."""
    blur: Annotated[float, msgspec.Meta(ge=0, le=20)] = 1.0
    """Depth of field: blur in pixels of a 1280 wide frame at the nearest and farthest moving part; 0 is a pinhole."""
    orbit: Annotated[float, msgspec.Meta(ge=0, le=45)] = 0.0
    """Degrees the camera swings to each side, once a turn, so that the film still loops."""
    follow: bool | None = None
    """True if the camera goes along with the machine, damped. Null follows what goes away and does not come back: a
    car, a walker, a projectile."""


class Trail(_Strict, frozen=True):
    """The path of a traced point, a thin light that fades behind it."""

    point: str
    colour: Colour | None = None
    """Linear RGB; null is the colour of trails in every picture, darker where what is behind them is bright."""
    tail: Annotated[float, msgspec.Meta(gt=0, le=1)] = 0.92
    """Length behind the point, in turns; of a motion without a period in parts of it."""
    radius: Annotated[float, msgspec.Meta(gt=0, le=0.1)] = 0.0046
    """At the point, as a part of the size of the swept motion."""
    z: float | None = None
    """Height (m); null is just above the body that carries the point."""
    ink: bool = False
    """True if it lies on something bright, such as paper: it is then as deep as ink in every look, and never shines."""


class Label(_Strict, frozen=True):
    """A short text that floats over a joint or a traced point and faces the camera."""

    at: str
    text: Annotated[str, msgspec.Meta(min_length=1, max_length=40)]
    size: Annotated[float, msgspec.Meta(gt=0, le=0.2)] = 0.028
    """Letter height, as a part of the size of the swept motion."""
    colour: Colour = (0.86, 0.88, 0.92)


Quantity = Literal["velocities", "accelerations", "forces", "reactions"]


class Title(_Strict, frozen=True):
    """Words over the picture: a name, the rate of time, and a number that follows the motion."""

    text: Annotated[str, msgspec.Meta(min_length=1, max_length=60)] | None = None
    """null is the mechanism's name."""
    number: str | None = None
    """A driver or force (its torque or force) or a traced point (its speed in m/s and km/h); null is the first of the
    drivers that give something, else of what acts in their place, else of the traced points; "" is none."""


Source = Literal["impacts", "knocks", "mesh", "gas", "motors", "friction", "springs"]
"""Sources of sound: blows, pins that change sides in their bores, teeth, combustion, drivers, what rubs, springs."""


class Sound(_Strict, frozen=True):
    """Sound of the film, computed from the motion; a shot says which sounds are left out."""

    without: tuple[Source, ...] = ()
    """Sources that are left out altogether."""
    silent: tuple[str, ...] = ()
    """Joints, drivers, forces and contacts that make no sound, such as a driver that is a hand and no motor."""


STORY_SHOTS = ("title", "assembly", "motion", "macro", "section", "reason", "last")
"""Shots of a story, in the order in which they follow each other where nothing else is said."""


class Story(_Strict, frozen=True):
    """Changes of the story (``STORY=explain``); docs/stories.md."""

    shots: Annotated[tuple[str, ...], msgspec.Meta(min_length=1, max_length=12)] | None = None
    """Names of :data:`STORY_SHOTS` in the order of the film; null is all of them, as far as the motion has them."""
    event: str | None = None
    """Moment of a stop: words of a moment, "rocker turns back", or a joint, driver or point at its peak; null is
    the first that the motion has of impacts, dead points, peaks."""
    caption: Annotated[str, msgspec.Meta(min_length=1, max_length=200)] | None = None
    """Text there in place of the words of the report."""
    joint: str | None = None
    """Joint of the macro; null is a joint of the event, or the one that lies on top."""
    curves: Annotated[tuple[str, ...], msgspec.Meta(max_length=3)] | None = None
    """Joints (their reaction), drivers or forces (their effort), traced points (their speed) in the strip; () is no
    strip, null what belongs to the event."""
    language: str = "en"


class Surface(_Strict, frozen=True):
    """Surface of a piece that none of the named materials has."""

    colour: Colour
    finish: Literal[
        "anodised", "brushed", "polished", "satin", "plastic", "printed", "rubber", "cast", "wood", "glass"
    ] = "anodised"
    roughness: Unit = 0.3


Part = Annotated[float, msgspec.Meta(ge=0, lt=1)]


class Section(_Strict, frozen=True):
    """Cut through the pieces, as fractions of the extent of the pieces that are cut.

    From one side it removes all beyond a plane; from two, as ``Section(front=0.5, right=0.5)``, the quarter beyond
    both.
    """

    front: Part = 0.0
    """Along the normal of the plane of the motion, from where it is seen."""
    right: Part = 0.0
    left: Part = 0.0
    """From where x is largest, or smallest, ..."""
    above: Part = 0.0
    below: Part = 0.0
    """... and y."""
    only: tuple[str, ...] = ()
    """Bodies, or pieces as "body/piece", that are cut; () is all of them from the front alone, and from other sides
    what stands still. What moves is cut as it stands at the start."""
    fixed: bool = False
    """True if planes stay where they are while bodies move through them, so that each moment has a cut of its own: all
    bodies are cut then, or those of ``only``, and parts are those of their reach over the whole motion."""


class Shot(_Strict, frozen=True):
    """Camera, look and film of one mechanism: shot.json."""

    schema: Literal["mbsd.shot"] = "mbsd.shot"
    schema_version: Literal[1] = 1
    camera: Camera = Camera()
    mount: Kind | None = None
    """How the machine stands: on a "desk", a "stand", at a "wall" or on the "ground"; the parts follow it. Null follows
    from the model: a machine stands where gravity acts in the plane, on the ground if its wheels run on it."""
    look: LookName | None = None
    """Light, ground and background. Null follows from the machine: a road for what drives on one, the studio for
    engines and what lies on a desk, white for what no motor moves, else a bench, or daylight if it is too large for
    one."""
    turns: Annotated[int, msgspec.Meta(ge=1, le=1000)] = 3
    """How many turns of the drivers the film shows, whole periods of the motion; after the first they cost nothing to
    render. A motion without a period is shown so often."""
    seconds_per_turn: Annotated[float, msgspec.Meta(gt=0, le=600)] | None = None
    """Film time of one turn, or of a whole motion without a period; null is 4 s a turn and 12 s at most a period, and
    the natural rate of a motion without one."""
    rate: Annotated[float, msgspec.Meta(gt=0)] | None = None
    """Seconds of the motion in a second of film, instead of ``seconds_per_turn``: 1 is real time, 0.1 is slowed ten
    times. Null plays a motion without a period in real time, or at the nearest round factor that makes it 1 .. 20 s."""
    hold: Annotated[float, msgspec.Meta(ge=0, le=60)] = 1.0
    """Film time for which a motion without a period stands at its end before it begins anew (s)."""
    fps: Annotated[int, msgspec.Meta(ge=1, le=120)] = 30
    trails: tuple[Trail, ...] | None = None
    """null trails every traced point; () trails none."""
    labels: tuple[Label, ...] = ()
    show: tuple[Quantity, ...] = ()
    """Quantities of arrows: velocities and accelerations of traced points and centres of mass, forces (springs, loads,
    contacts by penalty, weights), reactions (of joints and rigid contacts)."""
    title: Title | None = None
    """null writes nothing but the rate of a motion without a period that is not in real time."""
    materials: dict[str, str | Surface] = {}
    """Other surfaces for the film alone, by ``body`` or ``body/piece``: the name of a material or a Surface."""
    section: Part | Section = 0.0
    """Part of the machine's depth that is cut away from the front, or a Section: other sides, a quarter, certain
    pieces; cut faces are hatched. 0 cuts nothing."""
    transparent: tuple[str, ...] = ()
    """Bodies, or pieces as "body/piece", that are seen through as tinted glass is, such as covers."""
    sound: Sound = Sound()
    poster: Unit = 0.3
    """Moment of the poster, as a fraction of the motion."""
    story: Story = Story()
    """Changes of the story (``STORY=explain``)."""


def read_shot(path: Path) -> Shot:
    """Read shot.json; raises UserError naming the field."""
    return jsonfile.read(path, Shot)


def write_shot(path: Path, shot: Shot) -> None:
    """Check types, ranges and numbers, and write shot.json whole."""
    jsonfile.write(path, refuse_unsound(shot, path))


def refuse_unsound(shot: Shot, where: Path | str) -> Shot:
    """Return the shot with the types of its fields.

    Raises UserError naming ``where`` and the field whose type or range is wrong.
    """
    if shot.rate is not None and shot.seconds_per_turn is not None:
        raise UserError(f"{where}: rate and seconds_per_turn both say how fast the film goes; give one of them")
    jsonfile.refuse_non_finite(shot, where)
    if isinstance(shot.section, Section):
        for a, b in (("right", "left"), ("above", "below")):
            if getattr(shot.section, a) and getattr(shot.section, b):
                raise UserError(f"{where}: section cuts from {a} and from {b}; a section has one of them")
        if not any(getattr(shot.section, side) for side in ("front", "right", "left", "above", "below")):
            raise UserError(f"{where}: section cuts from no side; give front, right, left, above or below, 0 .. 1")
    return jsonfile.decode(jsonfile.encode(shot), Shot, where)


def shown(shot: Shot, words: str) -> Shot:
    """Return the shot changed by the ``words`` of SHOW, in order; without words unchanged."""
    asked = words.split(",")
    if not words:
        return shot
    title = (shot.title or Title()) if "title" in asked else None
    return msgspec.structs.replace(shot, show=tuple(q for q in get_args(Quantity) if q in asked), title=title)


@dataclass(frozen=True)
class Names:
    """Names that a shot may use: joints, traced points, and the pieces of each body."""

    mechanism: str
    joints: tuple[str, ...]
    points: tuple[str, ...]
    pieces: dict[str, tuple[str, ...]]
    efforts: tuple[str, ...] = ()
    """Drivers and forces that have one."""
    acting: tuple[str, ...] = ()
    """Drivers, forces and contacts."""

    @classmethod
    def from_motion(cls, motion: AnyMotion, parts: Parts) -> Names:
        """Return the names in a motion and its parts."""
        pieces = {body: tuple(solids.pieces) for body, solids in parts.bodies.items()}
        forces = [name for name, force in motion.forces.items() if getattr(force, "effort", ()) is not None]
        contacts = getattr(motion, "contacts", {})
        efforts, acting = (*motion.drivers, *forces), (*motion.drivers, *motion.forces, *contacts)
        return cls(motion.mechanism, tuple(motion.joints), tuple(motion.points), pieces, efforts, acting)

    def listed(self) -> tuple[object, ...]:
        """Return all names, for the key of a stage."""
        return self.mechanism, self.joints, self.points, tuple(self.pieces.items()), self.efforts, self.acting


def refuse_unknown(shot: Shot, names: Names) -> None:
    """Raise UserError for the first unknown name in the shot, with the known names."""
    known = partial(_known, names.mechanism)
    for index, trail in enumerate(shot.trails or ()):
        known(f"trails[{index}].point", trail.point, names.points)
    for index, label in enumerate(shot.labels):
        known(f"labels[{index}].at", label.at, (*names.joints, *names.points))
    if shot.title is not None and shot.title.number:
        known("title.number", shot.title.number, (*names.efforts, *names.points))
    for index, name in enumerate(shot.sound.silent):
        known(f"sound.silent[{index}]", name, (*names.joints, *names.acting))
    for index, shot_name in enumerate(shot.story.shots or ()):
        known(f"story.shots[{index}]", shot_name, STORY_SHOTS)
    _refuse_unseen(shot.story, names.mechanism)
    for index, curve in enumerate(shot.story.curves or ()):
        known(f"story.curves[{index}]", curve, dict.fromkeys((*names.joints, *names.efforts, *names.points)))
    if shot.story.joint is not None:
        known("story.joint", shot.story.joint, names.joints)
    pieces = [f"{body}/{piece}" for body, solids in names.pieces.items() for piece in solids]
    for field, given in (("section.only", _only(shot)), ("transparent", shot.transparent)):
        for index, name in enumerate(given):
            known(f"{field}[{index}]", name, [*names.pieces, *pieces])
    for name, surface in shot.materials.items():
        known("materials", name, [*names.pieces, *pieces])
        if isinstance(surface, str):
            known(f"materials['{name}']", surface, MATERIALS)


def _refuse_unseen(story: Story, mechanism: str) -> None:
    """Raise UserError for a wish whose shot the story leaves out."""
    for field, seen_in in (("caption", "reason"), ("joint", "macro")):
        if getattr(story, field) is not None and story.shots is not None and seen_in not in story.shots:
            raise UserError(
                f"{mechanism}: shot.story.{field} is for the shot '{seen_in}', which shot.story.shots leaves out; "
                f"add '{seen_in}' to the shots, or remove the {field}"
            )


def _only(shot: Shot) -> tuple[str, ...]:
    return shot.section.only if isinstance(shot.section, Section) else ()


def _known(mechanism: str, field: str, name: str, names: Iterable[str]) -> None:
    known = list(names)
    if name not in known:
        raise UserError(
            f"{mechanism}: shot.{field} names '{name}', which does not exist; known: {', '.join(known) or 'none'}"
            f"{did_you_mean(name, known)}"
        )
