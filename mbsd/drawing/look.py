"""Colours of the drawings, and inks of bodies. Lightness is that of OKLab.

An ink is dark enough for text on white (contrast 4.5, WCAG 2) and apart from others for colour-blind eyes. Bodies of
one material get shades that differ.

OKLab: B. Ottosson, "A perceptual color space for image processing", 2020.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar, cast

import numpy as np

from mbsd.model.mechanism import Model

INK = "#20252b"
QUIET = "#6b747e"
FAINT = "#e9ecef"
PAPER = "#ffffff"
MOVED = "#c2410c"
"""Drivers."""
LOAD = "#4b5563"
"""Forces."""
WRONG = "#c81e1e"
"""Open joints, redundant joints."""
AXIS_X, AXIS_Y = "#d0453a", "#2f8f4e"
PALETTE = ("#0b62a8", "#00805e", "#a83a82", "#8a6d00", "#5a4fcf", "#3b7d8c", "#8f4a1d", "#4d6b1f")


def colour(index: int) -> str:
    """Return the colour of the body with this number, ground not counted."""
    return PALETTE[index % len(PALETTE)]


INKS: Mapping[str, str] = {
    "orange": "#c4500a",
    "blue": "#0b62a8",
    "red": "#a3172c",
    "green": "#1b7a48",
    "violet": "#6f45b8",
    "gold": "#8a6d00",
    "silver": "#66717b",
}
"""Colours by words; shared/contract/materials.py has the same for its materials."""
DRIVEN = "orange"
ON_GROUND = ("blue", "red", "green", "violet")
BETWEEN = ("silver", "gold")
FREE = ("orange", "blue", "gold", "green", "red", "violet")
"""Words by role, of which bodies of one role take turns: driven on ground, on ground, between, held by nothing."""
SLATE = ("#51606e", "#6a5f57", "#4a6668", "#655a70", "#5f6650")
"""Colours of bodies where arrows are to be seen, in turn: signal colours belong to quantities alone."""
DARKER = (0.0, -0.11, -0.055, -0.17, -0.085)
"""Shades of one ink in turn, in lightness."""
TINTS = (250.0, 70.0, 150.0, 330.0)
"""Hues (degrees) that tell greys apart, in turn."""
TURNED = 16.0
"""Degrees of hue by which shades of a colour differ, in turn to either side."""
GREY = 0.03
"""Chroma below this is a grey."""
_TO_LMS = np.array([
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
])  # fmt: skip
_TO_LAB = np.array([
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
])  # fmt: skip


def colours_by_role(m: Model) -> dict[str, str]:
    """Return the word of the colour of each moving body, in the model's order."""
    held = {name for joint in m.joints.values() for name in joint.bodies}
    driven = {name for driver in m.drivers.values() for name in driver.bodies} - {"ground"}
    grounded = {name for joint in m.joints.values() if "ground" in joint.bodies for name in joint.bodies} - {"ground"}
    out: dict[str, str] = {}
    turns = {ON_GROUND: 0, BETWEEN: 0, FREE: 0}
    for name in m.bodies:
        if name == "ground":
            continue
        if name in held and name in driven and name in grounded:
            out[name] = DRIVEN
            continue
        colours = FREE if name not in held else ON_GROUND if name in grounded else BETWEEN
        out[name] = colours[turns[colours] % len(colours)]
        turns[colours] += 1
    return out


def body_inks(m: Model) -> dict[str, str]:
    """Return the ink of each moving body of a model by its role, ``#rrggbb`` on light paper."""
    return apart({name: INKS[word] for name, word in colours_by_role(m).items()})


def neutral_inks(names: Iterable[str]) -> dict[str, str]:
    """Return quiet greys for bodies beside arrows, no two the same."""
    names = [name for name in names if name != "ground"]
    return {name: f"#{int(SLATE[k % len(SLATE)][1:], 16) + k // len(SLATE):06x}" for k, name in enumerate(names)}


def apart(inks: Mapping[str, str]) -> dict[str, str]:
    """Return the same inks, those that several bodies have in shades that differ; no two are the same."""
    out: dict[str, str] = {}
    times: dict[str, int] = {}
    for name, ink in inks.items():
        k = times[ink] = times.get(ink, -1) + 1
        made = ink if k == 0 else _shade(ink, k)
        while made in out.values():
            made = f"#{(int(made[1:], 16) + 1) % 0x1000000:06x}"
        out[name] = made
    return out


def on_dark(ink: str) -> str:
    """Return the same colour on dark paper: as far from it as the ink is from white, its hue kept."""
    light, chroma, hue = lch_of(ink)
    return hex_of(1.16 - 0.8 * light, 0.9 * chroma, hue)


def _shade(ink: str, k: int) -> str:
    light, chroma, hue = lch_of(ink)
    if chroma < GREY:
        chroma, hue = GREY, TINTS[(k - 1) % len(TINTS)]
    else:
        hue += TURNED * (0, 1, -1)[k % 3]
    return hex_of(min(light + DARKER[k % len(DARKER)], 0.56), chroma, hue)


def lch_of(ink: str) -> tuple[float, float, float]:
    """Return lightness, chroma and hue (degrees) of ``#rrggbb`` in OKLab."""
    rgb = np.array([int(ink[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    light, a, b = _TO_LAB @ np.cbrt(_TO_LMS @ linear)
    return float(light), float(np.hypot(a, b)), float(np.degrees(np.arctan2(b, a)))


def hex_of(light: float, chroma: float, hue: float) -> str:
    """Return ``#rrggbb``, with less chroma where the screen has no such colour."""
    turn = np.radians(hue)
    for part in np.linspace(1.0, 0.0, 21):
        lab = np.array([light, part * chroma * np.cos(turn), part * chroma * np.sin(turn)])
        linear = np.linalg.solve(_TO_LMS, np.linalg.solve(_TO_LAB, lab) ** 3)
        if linear.min() >= -1e-4 and linear.max() <= 1.0 + 1e-4:
            break
    linear = np.clip(linear, 0.0, 1.0)
    rgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return "#" + "".join(f"{round(255 * float(channel)):02x}" for channel in rgb)


F = TypeVar("F", bound=Callable[..., Any])


def literal(draw: F) -> F:
    """Return ``draw`` with names shown as written.

    Matplotlib takes text between dollar signs for a formula.
    """

    @functools.wraps(draw)
    def inner(*given: Any, **named: Any) -> Any:
        try:
            import matplotlib as mpl
        except ImportError:
            return draw(*given, **named)
        with mpl.rc_context({"text.parse_math": False}):
            return draw(*given, **named)

    return cast(F, inner)
