"""URDF: the tree of bodies.

What closes loops is a ``loop_joint``, which readers that know no loops pass over.

The plane of the motion is x y; a pin in a slot is a slide and a hinge with a link of no mass between.
"""

from __future__ import annotations

import math
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from mechanisms.stages.export.tree import GROUND, Node, number, numbers, poses_of, tree_of


def urdf(solution: Any) -> tuple[str, list[str]]:
    """Return the file's text, and what it leaves out."""
    m = solution.mechanism
    tree = tree_of(m, poses_of(solution))
    root = Element("robot", name=m.name)
    SubElement(root, "link", name=GROUND)
    for node in tree.nodes:
        _link(root, node)
        _joint(root, node)
    for joint in tree.loops:
        kind = {"revolute": "continuous", "weld": "fixed"}.get(joint.kind.name)
        if kind is None:
            tree.left_out.append(f"joint '{joint.name}' ({joint.kind.name}), which closes a loop")
            continue
        loop = SubElement(root, "loop_joint", name=joint.name, type=kind)
        for which, marker in (("link1", joint.i), ("link2", joint.j)):
            SubElement(loop, which, link=marker.body.name, xyz=numbers(marker.x, marker.y, 0.0),
                       rpy=numbers(0.0, 0.0, marker.angle))  # fmt: skip
        SubElement(loop, "axis", xyz="0 0 1")
    left_out = [*tree.left_out, *(f"force '{name}' ({force.kind.name})" for name, force in m.forces.items())]
    indent(root)
    return '<?xml version="1.0"?>\n' + tostring(root, encoding="unicode") + "\n", left_out


def _link(root: Element, node: Node) -> None:
    body = node.body
    link = SubElement(root, "link", name=body.name)
    if body.mass > 0.0:
        inertial = SubElement(link, "inertial")
        SubElement(inertial, "origin", xyz=numbers(*body.com, 0.0), rpy="0 0 0")
        SubElement(inertial, "mass", value=number(body.mass))
        about = {"ixx": number(body.inertia / 2), "iyy": number(body.inertia / 2), "izz": number(body.inertia)}
        SubElement(inertial, "inertia", {**about, "ixy": "0", "ixz": "0", "iyz": "0"})
    if body.length:
        visual = SubElement(link, "visual")
        SubElement(visual, "origin", xyz=numbers(body.length / 2, 0.0, 0.0), rpy=numbers(0.0, math.pi / 2, 0.0))
        SubElement(
            SubElement(visual, "geometry"), "cylinder", radius=number(body.length / 30), length=number(body.length)
        )


def _joint(root: Element, node: Node) -> None:
    """The joint that attaches a body.

    URDF turns a link about its own origin, so links between move the axis there.
    """
    name, pose = node.body.name, node.pose
    if node.joint is None:
        chain = [
            ("x", "prismatic", (1.0, 0.0, 0.0)),
            ("y", "prismatic", (0.0, 1.0, 0.0)),
            ("turn", "continuous", (0.0, 0.0, 1.0)),
        ]
        _chain(root, node.parent, name, chain, (0.0, 0.0, 0.0), (pose.x, pose.y, pose.angle), (0.0, 0.0))
        return
    (x, y), kind = node.anchor, node.joint.kind.name
    c, s = math.cos(pose.angle), math.sin(pose.angle)
    place = (pose.x + c * x - s * y, pose.y + s * x + c * y)
    along = (math.cos(node.guide), math.sin(node.guide), 0.0)
    turn = ("turn", "continuous", (0.0, 0.0, 1.0))
    slide = ("slide", "prismatic", along)
    chains = {"weld": [("weld", "fixed", (0.0, 0.0, 1.0))], "revolute": [turn], "prismatic": [slide]}
    chain = chains.get(kind) or ([slide, turn] if node.own_is_j else [turn, slide])
    _chain(root, node.parent, name, chain, (*place, pose.angle), None, (x, y))


def _chain(
    root: Element, parent: str, child: str, chain: list[tuple[str, str, tuple[float, float, float]]],
    origin: tuple[float, float, float], last: tuple[float, float, float] | None, offset: tuple[float, float],
) -> None:  # fmt: skip
    """Joints one after the other at one place, and a fixed one from there to the child's own frame."""
    above = parent
    place = origin if last is None else last
    for k, (what, kind, axis) in enumerate(chain):
        below = f"{child} {what}"
        SubElement(root, "link", name=below)
        joint = SubElement(root, "joint", name=f"{child} {what} joint", type=kind)
        SubElement(joint, "origin", xyz=numbers(*(place[:2] if k == 0 else (0.0, 0.0)), 0.0),
                   rpy=numbers(0.0, 0.0, place[2] if k == 0 else 0.0))  # fmt: skip
        SubElement(joint, "parent", link=above)
        SubElement(joint, "child", link=below)
        if kind != "fixed":
            SubElement(joint, "axis", xyz=numbers(*axis))
        if kind == "prismatic":
            SubElement(joint, "limit", lower="-1000", upper="1000", effort="1e9", velocity="1e9")
        above = below
    fixed = SubElement(root, "joint", name=f"{child} frame", type="fixed")
    SubElement(fixed, "origin", xyz=numbers(-offset[0], -offset[1], 0.0), rpy="0 0 0")
    SubElement(fixed, "parent", link=above)
    SubElement(fixed, "child", link=child)
