"""Vibration of the frame in data.json: inertia forces, centre of mass, harmonics of the crank."""

from __future__ import annotations

from shared.contract.base import Series, Strict


class Harmonics(Strict, kw_only=True):
    """Harmonics of a quantity that repeats with the crank, one for each order of :class:`Vibration`.

    Along an axis it is mean + sum of amplitude cos(order phi + phase), phi the crank's angle.
    """

    unit: str
    mean: list[float]
    """Along each axis: one of a number, two (x, y) of a vector."""
    amplitude: list[Series]
    phase: list[Series]
    """rad."""
    forward: Series
    """Size of the part that turns with the crank, order times as fast; half of the amplitude of a number."""
    backward: Series
    """Size of the part that turns against it."""


class Vibration(Strict, kw_only=True):
    """Vibration of a motion that repeats with a crank."""

    about: tuple[float, float]
    """Place of ground about which the moment is (m): the axis of the crank."""
    fx: Series
    """Force of the inertia of all bodies on the frame (N)."""
    fy: Series
    moment: Series
    """N m."""
    x: Series
    """Centre of mass of all bodies (m)."""
    y: Series
    crank: str
    turns: int
    """Turns of the crank in a cycle."""
    order: Series
    harmonics: dict[str, Harmonics]
    """By quantity: the shaking force, moment and couple, efforts of drivers, reactions of joints with ground."""
