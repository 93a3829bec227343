"""Axes about which two bodies turn against each other, however they move."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from mechanisms.stages.clearance.path import BodyPath, points, relative
from shared.contract import Motion, Parts
from shared.shapes.units import mm

type Axes = dict[frozenset[str], dict[str, np.ndarray]]
"""By pair of bodies: the axis of their joint, as a point (mm) in the frame of either."""


def axes_of(motion: Motion, parts: Parts, where: Mapping[str, BodyPath]) -> Axes:
    """Axes of bodies that a revolute joint or a rod's end connects, and of those that turn on a common pin."""
    axes: Axes = {}
    for joint in motion.joints.values():
        if joint.kind != "revolute":
            continue
        at = np.column_stack([np.array(joint.x) * mm(1), np.array(joint.y) * mm(1), np.zeros(len(joint.x))])
        seen = {body: relative(at, where[body].pose)[:, :2] for body in joint.bodies}
        if all(np.ptp(point, axis=0).max() < 1e-4 for point in seen.values()):
            axes[frozenset(joint.bodies)] = {body: point.mean(axis=0) for body, point in seen.items()}
    for rod, described in parts.bodies.items():
        for end in described.spans or ():
            own = np.array([end.x, end.y]) * mm(1)
            at = points(where[end.body].pose, own)
            point = relative(np.column_stack([at, np.zeros(len(at))]), where[rod].pose)[:, :2]
            if np.ptp(point, axis=0).max() < 1e-4:
                axes[frozenset((rod, end.body))] = {rod: point.mean(axis=0), end.body: own}
    return _with_common_pins(axes)


def _with_common_pins(axes: Axes) -> Axes:
    """Also bodies that turn on a common pin without a joint between the two of them."""
    waiting = list(axes.items())
    while waiting:
        pair, at = waiting.pop()
        for other, there in list(axes.items()):
            for body in pair & other:
                ends = pair ^ other
                if len(ends) == 2 and ends not in axes and np.abs(at[body] - there[body]).max() < 1e-4:
                    axes[ends] = {end: (at | there)[end] for end in ends}
                    waiting.append((ends, axes[ends]))
    return axes
