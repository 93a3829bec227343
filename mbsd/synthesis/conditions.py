"""Conditions on a linkage: Grashof's inequality, and transmission angles at its pins.

Grashof: the shortest link of a four-bar turns fully against the others when s + l <= p + q, s and l the shortest and
longest of the four lengths. Transmission angle: at a pin between two links that push on each other, the angle between
the lines from it to their other pins, folded to 0 .. pi/2; near 0 the linkage jams.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model


class Pin(NamedTuple):
    """A revolute joint between two links that no driver moves, each with one other pin."""

    joint: str
    bodies: tuple[str, str]
    inner: tuple[int, int]
    outer: tuple[int, int]
    """Marker numbers on the two bodies: at the pin, and at each body's other pin."""


def pins(m: Model, packed: Packed) -> list[Pin]:
    """Return the pins at which a transmission angle is defined."""
    moved = {body for driver in m.drivers.values() for body in driver.bodies} | {"ground"}
    pins_between = []
    places = _pin_markers(m, packed)
    for joint in _revolutes(m):
        a, b = joint.bodies
        if a in moved or b in moved:
            continue
        others = [[number for name, number in places[body] if name != joint.name] for body in (a, b)]
        if all(len(other) == 1 for other in others):
            own = [next(number for name, number in places[body] if name == joint.name) for body in (a, b)]
            pins_between.append(Pin(joint.name, (a, b), (own[0], own[1]), (others[0][0], others[1][0])))
    return pins_between


def transmission_angles(pin: Pin, arms: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return (n, T) transmission angles (rad) of designs with marker places ``arms`` (n, markers, 2) (m).

    ``first``, ``second``: (n, T) angles of the pin's bodies.
    """
    lines = []
    for side, turn in enumerate((first, second)):
        line = arms[:, pin.outer[side]] - arms[:, pin.inner[side]]
        lines.append(turn + np.arctan2(line[:, 1], line[:, 0])[:, None])
    return np.arccos(np.clip(np.abs(np.cos(lines[1] - lines[0])), 0.0, 1.0))


def four_bar(m: Model, packed: Packed) -> list[tuple[int, int]]:
    """Return pairs of marker numbers whose distances are the four lengths, ground's among them.

    Raises ModelError where the mechanism is no four-bar of pins.
    """
    places = _pin_markers(m, packed)
    loops = {body: [number for _, number in markers] for body, markers in places.items() if markers}
    if len(loops) != 4 or len(_revolutes(m)) != 4 or any(len(numbers) != 2 for numbers in loops.values()):
        raise ModelError(
            f"{m.name}: fit_path: grashof=True needs a four-bar of four pins, and this is another mechanism. Leave it "
            "out: a design counts only if its links close over the whole motion"
        )
    return [(numbers[0], numbers[1]) for numbers in loops.values()]


def grashof_excess(lengths: np.ndarray) -> np.ndarray:
    """Return (n,) s + l - p - q of lengths (n, 4), relative to their sum.

    It is positive where Grashof's condition fails.
    """
    ordered = np.sort(lengths, axis=1)
    return (ordered[:, 0] + ordered[:, 3] - ordered[:, 1] - ordered[:, 2]) / ordered.sum(axis=1)


def _revolutes(m: Model) -> Sequence[Joint]:
    return [joint for joint in m.joints.values() if joint.kind.pair == "pin"]


def _pin_markers(m: Model, packed: Packed) -> dict[str, list[tuple[str, int]]]:
    """Return, by body, its revolute joints and the numbers of their markers on it."""
    out: dict[str, list[tuple[str, int]]] = {body: [] for body in m.bodies}
    for joint, pair in zip(packed.joints, packed.markers, strict=True):
        if joint.kind.pair == "pin":
            for body, number in zip(joint.bodies, pair, strict=True):
                out[body].append((joint.name, int(number)))
    return out
