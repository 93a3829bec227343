"""The mechanism as a tree of bodies, as models of robots have it, and numbers as text."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

# Numbers as XML files of other programs have them.

DIGITS = 15
ROUNDING = 1e-15
"""Less is written as zero."""


def number(value: float) -> str:
    """Return one number with all the digits that matter."""
    return f"{value:.{DIGITS}g}"


def numbers(*values: float) -> str:
    """Return several, with spaces between."""
    return " ".join(number(0.0 if abs(value) < ROUNDING else value) for value in values)


# A mechanism as a tree of bodies with the joints that close its loops, as simulators of robots describe machines.
#
# From the ground outwards one joint attaches each body; a joint between two bodies that are attached closes a loop.
# Poses are those at the start of a solution, where all loops are closed.

GROUND = "ground"
ATTACHING = ("revolute", "prismatic", "pin_in_slot", "weld")
"""Kinds of joints that may attach a body."""
CLOSING = ("revolute", "weld", "distance")
"""Kinds that may close a loop."""
MESHING = ("gear_pair", "belt")
"""Kinds that tie two turns to each other."""


@dataclass(frozen=True)
class Pose:
    """A frame: place (m) and angle (rad)."""

    x: float
    y: float
    angle: float

    def seen_from(self, other: Pose) -> Pose:
        """Return this frame in the axes of another."""
        dx, dy = self.x - other.x, self.y - other.y
        c, s = math.cos(other.angle), math.sin(other.angle)
        return Pose(c * dx + s * dy, c * dy - s * dx, math.remainder(self.angle - other.angle, math.tau))


@dataclass
class Node:
    """One body, how it is attached, and where its frame is in its parent's at the start."""

    body: Any
    parent: str
    joint: Any | None
    """None: nothing holds it, so it moves freely in the plane."""
    own_is_j: bool
    """True if the joint's second marker is the one on this body."""
    pose: Pose

    @property
    def marker(self) -> Any:
        """The joint's marker on this body."""
        assert self.joint is not None
        return self.joint.j if self.own_is_j else self.joint.i

    @property
    def anchor(self) -> tuple[float, float]:
        """Where its joint acts, in this body's axes at the start (m): at the pin, also of a slot on this body."""
        assert self.joint is not None
        if self.joint.kind.name == "pin_in_slot" and not self.own_is_j:
            pin = Pose(self.joint.j.x, self.joint.j.y, 0.0).seen_from(self.pose)
            return pin.x, pin.y
        return self.marker.x, self.marker.y

    @property
    def guide(self) -> float:
        """Direction of the x axis of the joint's first marker, in this body's axes at the start (rad)."""
        assert self.joint is not None
        if not self.own_is_j:
            return self.joint.i.angle
        return self.joint.i.angle - self.pose.angle


@dataclass
class Tree:
    """All bodies, parents before children, and what closes loops."""

    nodes: list[Node] = field(default_factory=list)
    loops: list[Any] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    """Elements that such a description cannot express, by name."""

    def children(self, parent: str) -> list[Node]:
        """Return the nodes that are attached to a body."""
        return [node for node in self.nodes if node.parent == parent]


def tree_of(m: Any, poses: dict[str, Pose]) -> Tree:
    """Return the tree of a mechanism whose bodies stand so at the start."""
    tree, attached = Tree(), {GROUND}
    waiting = _spanning(m)
    used = {joint.name for joint in waiting}
    while len(attached) < len(m.bodies):
        joint = next(
            (edge for edge in waiting if (edge.i.body.name in attached) != (edge.j.body.name in attached)), None
        )
        if joint is None:  # nothing holds what is left: its first body is free
            name = next(name for name in m.bodies if name not in attached)
            tree.nodes.append(Node(m.bodies[name], GROUND, None, True, poses[name]))
            attached.add(name)
            continue
        own_is_j = joint.i.body.name in attached
        parent, child = (joint.i, joint.j) if own_is_j else (joint.j, joint.i)
        name, above = child.body.name, parent.body.name
        tree.nodes.append(Node(m.bodies[name], above, joint, own_is_j, poses[name].seen_from(poses[above])))
        attached.add(name)
        waiting.remove(joint)
    for joint in m.joints.values():
        if joint.name in used:
            continue
        if joint.kind.name in (*CLOSING, *MESHING):
            tree.loops.append(joint)
        else:
            tree.left_out.append(f"joint '{joint.name}' ({joint.kind.name})")
    tree.left_out += [f"contact '{name}' ({contact.kind.name})" for name, contact in m.contacts.items()]
    return tree


def _spanning(m: Any) -> list[Any]:
    """Return joints that connect what they can without a loop.

    Pins that are driven come before those that cannot close a loop, other pins last.
    """
    driven = {frozenset(driver.bodies) for driver in m.drivers.values() if driver.kind.angular}

    def rank(joint: Any) -> int:
        if joint.kind.name == "revolute":
            return 0 if frozenset(joint.bodies) in driven else 2
        return 1

    root = {name: name for name in m.bodies}

    def top(name: str) -> str:
        while root[name] != name:
            name = root[name]
        return name

    chosen = []
    for joint in sorted((joint for joint in m.joints.values() if joint.kind.name in ATTACHING), key=rank):
        first, second = top(joint.i.body.name), top(joint.j.body.name)
        if first != second:
            root[first] = second
            chosen.append(joint)
    return chosen


def poses_of(solution: Any) -> dict[str, Pose]:
    """Return where the frames of all bodies are at the first output."""
    poses = {GROUND: Pose(0.0, 0.0, 0.0)}
    for name in solution.mechanism.bodies:
        if name != GROUND:
            view = solution.body(name)
            poses[name] = Pose(float(view.x[0]), float(view.y[0]), float(view.theta[0]))
    return poses
