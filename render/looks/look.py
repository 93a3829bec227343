"""What a look is made of: plain data that Blender's scene and the page both read.

Places are (right, away, up) as the camera stands, in radii of the swept motion around its middle, so that a machine of
any size stands in the same light. A lamp's power grows with the square of its distance. Colours are linear RGB.
"""

from __future__ import annotations

from typing import Literal

import msgspec

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
    """Parallel light from the direction of ``place``: W/m^2; ``angle`` is the disc's, in degrees: soft shadows."""

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
    """Where the page's one lamp with a shadow shines from, where there is no sun."""
    bounce: float = 0.0
    """Irradiance of ground and wall over pi: light that bounces meets them as lamps of their mean colour times this and
    goes no further; 0: they are lit for it, too."""


class Sky(msgspec.Struct, kw_only=True, frozen=True):
    """What shines from all around: from the horizon up to the zenith, and from below."""

    zenith: Colour
    horizon: Colour
    below: Colour


class Ground(msgspec.Struct, kw_only=True, frozen=True):
    """What the machine stands on: a texture between two colours."""

    texture: Texture
    colour: Colour
    other: Colour = (0.0, 0.0, 0.0)
    roughness: float = 0.5
    lines: Colour | None = None
    """Colour of the marks painted on a road."""


class Wall(msgspec.Struct, kw_only=True, frozen=True):
    """What stands behind: the floor bends up into it (sweep), or boards with holes hang there (pegboard)."""

    kind: Literal["sweep", "pegboard"]
    colour: Colour
    away: float
    """From the middle, or from what reaches farther."""


class Drawing(msgspec.Struct, kw_only=True, frozen=True):
    """Lines on paper instead of light: sRGB 0..1."""

    paper: Colour
    grid: Colour
    line: Colour
    tone: float
    """How far faces are lighter than the paper where they face the light."""


class Screen(msgspec.Struct, kw_only=True, frozen=True):
    """What the page needs beside, for WebGL has no light that is thrown back by what it falls on."""

    edge: Colour
    """What the floor fades into."""
    lamp: float = 2.6
    ambient: float = 0.0
    reflected: float = 0.5
    """Times the brightness of softboxes."""
    exposure: float = 1.0


class Look(msgspec.Struct, kw_only=True, frozen=True):
    """A look by name."""

    name: str
    dark: bool
    """Whether what lies over the picture is light on dark."""
    ground: Ground
    sky: Sky
    lying: Light = Light()
    """On a machine that lies, which is seen from above."""
    standing: Light = Light()
    """On a machine that stands, whose plates face the camera."""
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
