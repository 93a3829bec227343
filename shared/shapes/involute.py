"""Outlines of involute teeth (ISO 53: pressure angle 20 degrees): gears, ring gears, racks; mm.

A flank is the involute of the base circle, given by points on it; tips and roots are chords. ``play`` is taken from the
thickness of the teeth along the pitch circle, so two wheels in mesh have the sum of theirs.

Source: ISO 21771: with a tooth s thick at the pitch circle, half its angle at radius r is
s / (2 r_pitch) + inv(20 deg) - inv(alpha), cos alpha = r_base / r.
"""

from __future__ import annotations

import math

import cadquery as cq
import numpy as np

PRESSURE = math.radians(20.0)
ADDENDUM = 1.0
"""Height of a tooth above the pitch circle, in modules."""
DEDENDUM = 1.25
FLANK = 6
"""Points on a flank."""


def involute(angle: float) -> float:
    """Return inv(angle) = tan(angle) - angle."""
    return math.tan(angle) - angle


def longest_tip(radius: float, mate: float) -> float:
    """Return the largest tip radius of a gear that meets ``mate``'s flanks above their base circle."""
    return math.hypot(radius * math.cos(PRESSURE), (radius + mate) * math.sin(PRESSURE))


def shortest_tip(ring: float, mate: float) -> float:
    """Return the smallest tip radius of a ring that meets ``mate``'s flanks above their base circle."""
    return math.hypot(ring * math.cos(PRESSURE), (ring - mate) * math.sin(PRESSURE))


def foul_inside(pinion: float, tip: float, ring: float, ring_tip: float) -> bool:
    """Return True if tips of a pinion cross those of its ring gear beside the line of centres.

    Pitch and tip radii are given.

    Trochoid interference (KHK, Gear technical reference, Internal gears):

        no interference where  theta_1 r_1 / r_2 + inv(alpha) - inv(alpha_a2) >= theta_2
        theta_1 = acos((r_a2^2 - r_a1^2 - a^2) / (2 a r_a1)) + inv(alpha_a1) - inv(alpha)
        theta_2 = acos((a^2 + r_a2^2 - r_a1^2) / (2 a r_a2)),        a = r_2 - r_1,  cos(alpha_a) = r cos(alpha) / r_a
    """
    away = ring - pinion
    crossing = (ring_tip**2 - tip**2 - away**2) / (2 * away * tip)
    if crossing >= 1.0:
        return False
    own = math.acos(min(pinion * math.cos(PRESSURE) / tip, 1.0))
    other = math.acos(min(ring * math.cos(PRESSURE) / ring_tip, 1.0))
    first = math.acos(max(crossing, -1.0)) + involute(own) - involute(PRESSURE)
    second = math.acos(max(min((away**2 + ring_tip**2 - tip**2) / (2 * away * ring_tip), 1.0), -1.0))
    return first * pinion / ring + involute(PRESSURE) - involute(other) < second


def longest_rack_tip(pinion: float) -> float:
    """Return the greatest height of a rack's teeth that meet the pinion's flanks above its base circle.

    It is above the pitch line.
    """
    return pinion * math.sin(PRESSURE) ** 2


def rack_outline(
    teeth: int, module: float, tip: float, root: float, back: float, play: float, first: float = 0.0
) -> np.ndarray:
    """Return the outline of a rack, (4 teeth + 4, 2), counter-clockwise.

    Its pitch line is the x axis, its teeth point to +y.

    ``tip`` and ``root`` are heights, the root's below zero; ``back`` is what the bar has below the root. The first
    tooth is at x = ``first``; the bar begins and ends in the middle of a space.
    """
    pitch = math.pi * module
    half = pitch / 4 - play / 2
    flank = [(-half + root * math.tan(PRESSURE), root), (-half + tip * math.tan(PRESSURE), tip)]
    tooth = np.array([*flank, *((-x, y) for x, y in reversed(flank))])
    places = first + pitch * np.arange(teeth)
    top = np.concatenate([tooth + np.array([x, 0.0]) for x in places])
    low, high = places[0] - pitch / 2, places[-1] + pitch / 2
    ends = np.array([[high, root], [high, root - back], [low, root - back], [low, root]])
    return np.concatenate([top, ends])[::-1]


def toothed(teeth: int, module: float, tip: float, root: float, play: float, phase: float = 0.0) -> np.ndarray:
    """Return the outline of a wheel, (n, 2), counter-clockwise; a tooth points to ``phase`` (rad).

    ``tip`` and ``root`` are radii. The hole of a ring gear is such a wheel, too: its teeth are the ring's spaces, so
    ``play`` is negative, ``tip`` the ring's root and ``root`` the ring's tip.
    """
    pitch = teeth * module / 2
    base = pitch * math.cos(PRESSURE)
    thick = (math.pi * module / 2 - play) / (2 * pitch)
    low = max(base, root)
    roll = np.linspace(math.sqrt(max((low / base) ** 2 - 1, 0.0)), math.sqrt((tip / base) ** 2 - 1), FLANK)
    radii = base * np.sqrt(1 + roll**2)
    half = thick + involute(PRESSURE) - (roll - np.arctan(roll))
    if half[-1] <= 0:  # pointed before the tip
        keep = half > 0
        radii, half = radii[keep], half[keep]
    if root < low - 1e-9:
        radii, half = np.insert(radii, 0, root), np.insert(half, 0, half[0])
    angles = np.concatenate([-half, half[::-1]])
    flanks = np.concatenate([radii, radii[::-1]])
    turn = phase + 2 * math.pi * np.arange(teeth)[:, None] / teeth
    around = (turn + angles).ravel()
    out = np.tile(flanks, teeth)
    return np.column_stack([out * np.cos(around), out * np.sin(around)])


def wire(points: np.ndarray) -> cq.Wire:
    """Return a closed polygon."""
    return cq.Wire.makePolygon([cq.Vector(float(x), float(y), 0.0) for x, y in points], close=True)
