"""Looks as data: light, ground, background and exposure of a picture, for Blender and the page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import msgspec

from shared.contract import AnyMotion
from shared.contract.parts import Kind, Mount
from shared.contract.shot import Shot

# A look is plain data that Blender's scene and the page both read.
#
# Places are (right, away, up) as the camera stands, in radii of the swept motion around its middle, so that a machine
# of any size stands in the same light. A lamp's power grows with the square of its distance. Colours are linear RGB.

Colour = tuple[float, float, float]
Place = tuple[float, float, float]
Texture = Literal["paint", "wood", "concrete", "asphalt", "sand"]


class Softbox(msgspec.Struct, kw_only=True, frozen=True):
    """An area light; ``power`` is W for a radius of one metre."""

    name: str
    place: Place
    size: tuple[float, float]
    power: float
    colour: Colour = (1.0, 1.0, 1.0)
    aim: Place = (0.0, 0.0, 0.0)
    spread: float = 180.0
    fades: bool = False
    """Dims towards its rim, so that its edge in a reflection is a gradient; costs a little render time."""


class Sun(msgspec.Struct, kw_only=True, frozen=True):
    """Parallel light from the direction of ``place``, in W/m^2.

    ``angle`` is the disc's, in degrees, and makes shadows soft.
    """

    place: Place
    power: float
    colour: Colour = (1.0, 0.96, 0.90)
    angle: float = 1.5
    window: bool = False
    """It falls through the panes of a window, whose bars throw shadows."""


class Light(msgspec.Struct, kw_only=True, frozen=True):
    """The lamps of a look."""

    softboxes: tuple[Softbox, ...] = ()
    sun: Sun | None = None
    shadow: Place = (-0.9, 1.5, 4.2)
    """Place of the page's one lamp with a shadow, where there is no sun."""
    bounce: float = 0.0
    """Irradiance of ground and wall over pi: light that bounces meets them as lamps of their mean colour times this and
    goes no further; 0: they are lit for it, too."""


class Sky(msgspec.Struct, kw_only=True, frozen=True):
    """Light from all around: from the horizon up to the zenith, and from below."""

    zenith: Colour
    horizon: Colour
    below: Colour


class Ground(msgspec.Struct, kw_only=True, frozen=True):
    """The ground below the machine: a texture between two colours."""

    texture: Texture
    colour: Colour
    other: Colour = (0.0, 0.0, 0.0)
    roughness: float = 0.5
    lines: Colour | None = None
    """Colour of the marks painted on a road."""


class Wall(msgspec.Struct, kw_only=True, frozen=True):
    """The wall behind: the floor bends up into it (sweep), or boards with holes hang there (pegboard)."""

    kind: Literal["sweep", "pegboard"]
    colour: Colour
    away: float
    """Distance from the middle, or from what reaches farther."""


class Drawing(msgspec.Struct, kw_only=True, frozen=True):
    """Lines on paper instead of light: sRGB 0..1."""

    paper: Colour
    grid: Colour
    line: Colour
    tone: float
    """Part by which faces are lighter than the paper where they face the light."""


class Screen(msgspec.Struct, kw_only=True, frozen=True):
    """Light of the page: WebGL has no light that bounces."""

    edge: Colour
    """Colour that the floor fades into."""
    lamp: float = 2.6
    ambient: float = 0.0
    reflected: float = 0.5
    """Times the brightness of softboxes."""
    exposure: float = 1.0


class Look(msgspec.Struct, kw_only=True, frozen=True):
    """A look by name."""

    name: str
    dark: bool
    """True if what lies over the picture is light on dark."""
    ground: Ground
    sky: Sky
    lying: Light = Light()
    """Lights of a machine that lies, which is seen from above."""
    standing: Light = Light()
    """Lights of a machine that stands, whose plates face the camera."""
    wall: Wall | None = None
    """Null is open ground up to the horizon, in haze."""
    vice: bool = False
    """A bench vice and tools beside the machine."""
    exposure: float = 0.0
    contrast: str = "AgX - Base Contrast"
    screen: Screen
    other: str | None = None
    """The look of a page that is dark where this one is light, or light where it is dark; null is this one."""
    drawing: Drawing | None = None


# Workshop bench: boards of beech, a vice, a wall of pegboard with tools, the light of a lamp over the bench.

LAMP = Softbox(
    name="lamp", place=(-1.3, 0.5, 3.2), size=(0.9, 0.5), power=120.0, colour=(1.0, 0.90, 0.76), aim=(0.0, 0.2, -0.2)
)
WINDOW = Softbox(name="window", place=(-4.2, 0.4, 1.7), size=(1.6, 2.6), power=150.0, colour=(0.74, 0.86, 1.0))
BENCH_FRONT = Softbox(
    name="front", place=(-2.0, -2.2, 3.0), size=(0.9, 0.9), power=130.0, colour=(1.0, 0.92, 0.80), spread=80.0
)
WASH = Softbox(
    name="wash", place=(0.5, 0.3, 3.2), size=(2.2, 0.3), power=26.0, colour=(1.0, 0.86, 0.68), aim=(0.3, 1.6, 0.4)
)
SIDE = Softbox(name="side", place=(2.9, -2.5, 0.9), size=(1.3, 2.4), power=60.0, colour=(0.80, 0.90, 1.0))
BENCH_FILL = Softbox(name="fill", place=(2.4, -3.2, 2.0), size=(2.4, 1.6), power=40.0, colour=(1.0, 0.93, 0.84))

BENCH = Look(
    name="bench",
    dark=True,
    ground=Ground(texture="wood", colour=(0.36, 0.19, 0.085), other=(0.16, 0.070, 0.027), roughness=0.42),
    sky=Sky(zenith=(0.06, 0.06, 0.062), horizon=(0.05, 0.048, 0.046), below=(0.03, 0.028, 0.026)),
    lying=Light(softboxes=(LAMP, WINDOW, BENCH_FILL), shadow=LAMP.place, bounce=0.7),
    standing=Light(softboxes=(BENCH_FRONT, WASH, SIDE, BENCH_FILL), shadow=BENCH_FRONT.place, bounce=0.55),
    wall=Wall(kind="pegboard", colour=(0.085, 0.115, 0.118), away=1.1),
    vice=True,
    exposure=0.2,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.05, 0.028, 0.013), lamp=3.6, ambient=0.5, reflected=1.0, exposure=1.6),
)


# Blueprint: the machine drawn in pale lines on blue paper.

PAPER = (0.012, 0.075, 0.24)

BLUEPRINT = Look(
    name="blueprint",
    dark=True,
    ground=Ground(texture="paint", colour=PAPER, roughness=1.0),
    sky=Sky(zenith=(0.5, 0.5, 0.5), horizon=(0.5, 0.5, 0.5), below=(0.5, 0.5, 0.5)),
    drawing=Drawing(paper=(0.075, 0.245, 0.50), grid=(0.20, 0.38, 0.63), line=(0.90, 0.95, 1.0), tone=0.16),
    screen=Screen(edge=PAPER),
)


# White cyclorama: a cove that runs out into white, a large key from the left, a shadow that holds the machine down.

CYCLORAMA_KEY = Softbox(
    name="key", place=(-2.4, -0.9, 3.2), size=(1.3, 1.3), power=120.0, colour=(1.0, 0.975, 0.94), aim=(0.0, 0.0, -0.1)
)
FRONT = Softbox(
    name="front", place=(-2.5, -2.6, 2.8), size=(1.2, 1.2), power=150.0, colour=(1.0, 0.975, 0.94), aim=(0.0, 0.0, -0.1)
)
BACK = Softbox(
    name="back", place=(0.3, 3.0, 3.2), size=(5.0, 1.8), power=70.0, colour=(0.97, 0.985, 1.0), aim=(0.0, 0.6, 0.0)
)
RIM = Softbox(name="rim", place=(3.2, 1.2, 1.3), size=(0.6, 2.6), power=36.0, colour=(0.90, 0.95, 1.0))
COVE = Softbox(
    name="cove", place=(0.0, 1.6, 4.4), size=(9.0, 1.6), power=240.0, colour=(1.0, 1.0, 1.0), aim=(0.0, 7.0, 2.0)
)

CYCLORAMA = Look(
    name="cyclorama",
    dark=False,
    ground=Ground(texture="paint", colour=(0.70, 0.70, 0.70), roughness=0.6),
    sky=Sky(zenith=(0.34, 0.35, 0.36), horizon=(0.34, 0.35, 0.36), below=(0.34, 0.35, 0.36)),
    lying=Light(softboxes=(CYCLORAMA_KEY, BACK, RIM), shadow=CYCLORAMA_KEY.place),
    standing=Light(softboxes=(FRONT, COVE, RIM), shadow=FRONT.place),
    wall=Wall(kind="sweep", colour=(0.70, 0.70, 0.70), away=5.0),
    exposure=0.45,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.80, 0.80, 0.80), lamp=2.4, ambient=0.25, exposure=1.0),
    other="studio",
)


# Daylight: a pale floor beside a window; the sun draws its bars and a firm shadow, the sky fills.

BOUNCE = Softbox(name="bounce", place=(3.4, 0.8, 1.4), size=(0.8, 2.6), power=26.0, colour=(1.0, 0.92, 0.82))
SKY = Softbox(
    name="sky", place=(-1.0, 3.0, 3.0), size=(3.6, 1.8), power=44.0, colour=(0.82, 0.91, 1.0), aim=(0.0, 0.3, 0.0)
)

DAYLIGHT = Look(
    name="daylight",
    dark=False,
    ground=Ground(texture="concrete", colour=(0.60, 0.585, 0.56), other=(0.53, 0.515, 0.495), roughness=0.6),
    sky=Sky(zenith=(0.26, 0.32, 0.42), horizon=(0.30, 0.33, 0.37), below=(0.28, 0.27, 0.25)),
    lying=Light(
        softboxes=(SKY, BOUNCE),
        sun=Sun(place=(-2.2, 0.55, 2.3), power=4.2, colour=(1.0, 0.91, 0.78), angle=1.6, window=True),
    ),
    standing=Light(
        softboxes=(SKY, BOUNCE),
        sun=Sun(place=(-1.9, -1.7, 1.9), power=4.2, colour=(1.0, 0.91, 0.78), angle=1.6, window=True),
    ),
    wall=Wall(kind="sweep", colour=(0.62, 0.60, 0.57), away=5.0),
    exposure=0.45,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.66, 0.65, 0.63), lamp=3.4, ambient=0.2, exposure=1.05),
    other="studio",
)


# Road: asphalt with its marks under an open sky, haze at the horizon, a low sun from the side.

ROAD_SKY = Softbox(
    name="sky", place=(0.0, 2.8, 3.2), size=(4.0, 2.0), power=40.0, colour=(0.88, 0.94, 1.0), aim=(0.0, 0.2, 0.0)
)
SUN = Sun(place=(-2.0, -1.4, 1.9), power=4.6, colour=(1.0, 0.90, 0.76), angle=0.9)

ROAD = Look(
    name="road",
    dark=False,
    ground=Ground(
        texture="asphalt",
        colour=(0.125, 0.122, 0.118),
        other=(0.060, 0.058, 0.057),
        roughness=0.72,
        lines=(0.75, 0.75, 0.75),
    ),
    sky=Sky(zenith=(0.22, 0.34, 0.55), horizon=(0.66, 0.72, 0.80), below=(0.12, 0.12, 0.12)),
    lying=Light(softboxes=(ROAD_SKY,), sun=SUN),
    standing=Light(softboxes=(ROAD_SKY,), sun=SUN),
    exposure=0.25,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.66, 0.72, 0.80), lamp=4.4, ambient=0.3, exposure=1.6),
)


# Sand: ripples of a beach under a low warm sun, haze at the horizon.

SAND_SKY = Softbox(
    name="sky", place=(0.4, 2.8, 3.0), size=(4.0, 2.0), power=34.0, colour=(0.74, 0.86, 1.0), aim=(0.0, 0.2, 0.0)
)
SAND_WARM = (1.0, 0.85, 0.64)

SAND = Look(
    name="sand",
    dark=False,
    ground=Ground(texture="sand", colour=(0.60, 0.43, 0.26), other=(0.40, 0.27, 0.15), roughness=0.9),
    sky=Sky(zenith=(0.22, 0.38, 0.66), horizon=(0.80, 0.76, 0.70), below=(0.30, 0.24, 0.17)),
    lying=Light(softboxes=(SAND_SKY,), sun=Sun(place=(-2.4, 0.5, 1.5), power=4.4, colour=SAND_WARM, angle=1.0)),
    standing=Light(softboxes=(SAND_SKY,), sun=Sun(place=(-2.2, -1.3, 1.5), power=4.4, colour=SAND_WARM, angle=1.0)),
    exposure=0.2,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.80, 0.76, 0.70), lamp=4.0, ambient=0.2, exposure=1.1),
)


# Dark studio: a slate sweep without a horizon, one large softbox above and behind, a cool and a warm rim light.

OVERHEAD = Softbox(
    name="overhead",
    place=(-0.3, 3.4, 2.5),
    size=(5.0, 2.0),
    power=68.0,
    colour=(1.0, 0.985, 0.96),
    aim=(0.0, 0.3, 0.0),
    fades=True,
)
POOL = Softbox(
    name="pool",
    place=(1.3, -0.3, 4.2),
    size=(0.6, 0.6),
    power=70.0,
    colour=(1.0, 0.97, 0.94),
    aim=(0.15, 0.4, -0.3),
    spread=48.0,
)
COOL = Softbox(name="rim cool", place=(-3.2, 1.4, 0.9), size=(0.6, 2.8), power=105.0, colour=(0.42, 0.68, 1.0))
WARM = Softbox(name="rim warm", place=(3.2, 0.9, 0.8), size=(0.6, 2.8), power=90.0, colour=(1.0, 0.58, 0.28))
FILL = Softbox(name="fill", place=(-1.2, -3.8, 1.6), size=(3.4, 1.6), power=42.0, colour=(0.84, 0.91, 1.0))
KEY = Softbox(name="key", place=(-2.3, -2.6, 2.9), size=(1.5, 1.5), power=300.0, colour=(1.0, 0.97, 0.93), spread=110.0)
FACE = Softbox(
    name="face", place=(2.7, -2.7, 0.5), size=(1.2, 2.2), power=42.0, colour=(1.0, 0.985, 0.96), aim=(0.0, 0.0, 0.1)
)
"""Place that plates which face the camera mirror, from a camera that stands to the left of them."""
GLOW = Softbox(
    name="glow",
    place=(0.5, 2.6, 2.6),
    size=(1.0, 0.6),
    power=760.0,
    colour=(0.72, 0.84, 1.0),
    aim=(0.3, 6.6, 0.2),
    spread=120.0,
)

STUDIO = Look(
    name="studio",
    dark=True,
    ground=Ground(texture="paint", colour=(0.016, 0.019, 0.026), roughness=0.34),
    sky=Sky(zenith=(0.016, 0.018, 0.024), horizon=(0.016, 0.018, 0.024), below=(0.016, 0.018, 0.024)),
    lying=Light(softboxes=(OVERHEAD, POOL, COOL, WARM, FILL)),
    standing=Light(softboxes=(KEY, FACE, GLOW, COOL, WARM), shadow=(-1.6, -1.6, 3.4)),
    wall=Wall(kind="sweep", colour=(0.016, 0.019, 0.026), away=5.0),
    exposure=0.1,
    contrast="AgX - High Contrast",
    screen=Screen(edge=(0.0035, 0.0045, 0.007), lamp=3.0, reflected=0.7, exposure=1.15),
    other="cyclorama",
)


# All looks by name.

LOOKS: dict[str, Look] = {look.name: look for look in (STUDIO, CYCLORAMA, BENCH, DAYLIGHT, ROAD, SAND, BLUEPRINT)}


# The look of a machine whose shot.py names none, by what its files say of it.

SMALL, LARGE, HUGE = 0.3, 0.8, 3.0
"""Sizes (m): what is smaller stands on a bench, even if it rolls; what is larger is too large for one; what is larger
still stands outdoors."""


@dataclass(frozen=True)
class Family:
    """Facts that decide the look: stand, gas or motor drive, the diagonal of its sweep (m)."""

    mount: Kind | Literal["bench"]
    engine: bool
    driven: bool
    size: float

    @classmethod
    def from_motion(cls, motion: AnyMotion, mount: Mount, size: float) -> Family:
        """Return the family of a machine with these files."""
        engine = any(getattr(force, "gas", None) is not None for force in motion.forces.values())
        return cls(mount.kind, engine, bool(motion.drivers), size)


def chosen(family: Family) -> str:
    """Return the look that suits a family.

    Vehicles are on a road, engines in the dark studio, what is left to itself before white; what is driven stands on a
    bench, or in daylight where it is too large for one or hangs at a wall, and in the studio where it lies. What rolls
    and is small enough is on a bench, too; what is huge is outdoors.
    """
    if family.mount == "ground":
        return "bench" if family.size < SMALL else "road"
    if family.engine:
        return "studio"
    if family.size > HUGE and family.mount == "stand":
        return "road"
    if not family.driven:
        return "cyclorama"
    if family.mount == "wall" or family.size > LARGE:
        return "daylight"
    return "studio" if family.mount == "desk" else "bench"


def look_of(shot: Shot, motion: AnyMotion, mount: Mount, size: float) -> Look:
    """Return the look that a shot names, else the one chosen."""
    return LOOKS[shot.look or chosen(Family.from_motion(motion, mount, size))]
