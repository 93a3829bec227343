"""All solids of a mechanism in space by body, from its model and its motion."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from mbsd.spatial.results.solution import Solution
from mechanisms.stages.automatic.space.base import Base
from mechanisms.stages.automatic.space.bodies import body_parts
from mechanisms.stages.automatic.space.ends import Ends
from mechanisms.stages.automatic.space.moves import Array, Moves
from mechanisms.stages.automatic.space.pieces import Line, Link, Part, gather_blocks
from mechanisms.stages.automatic.space.round import across
from shared.contract.parts import mounted_in_space
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.stage.console import Shown

LINK = "aluminium"


def solids_in_space(solution: Solution) -> Bodies:
    """Return every piece by the body it moves with, in mm; links of joints have names of their own.

    Raises UserError naming the joint for which there is no shape.
    """
    m = solution.mechanism
    moves = Moves(m, solution)
    ends = Ends(moves)
    mount = mounted_in_space(m.name, m.gravity)
    made, lines = Bodies(), dict[str, list[Line]]()
    materials = _materials(m)
    shown = Shown("parts", m.name, len(m.bodies) + len(ends.links), "bodies shaped")
    used: set[str] = set()
    for name, body in m.bodies.items():
        shown.advance()
        if name != "ground":
            parts, lines[name] = body_parts(body, ends.ends[name], moves.sizes, materials[name], ends.rims.get(name))
            made[name] = _solids(name, parts, used)
    for link in ends.links:
        shown.advance()
        name = link.joint if link.joint not in m.bodies else f"{link.joint}_link"
        lines[name] = link.lines
        moves.poses[name] = link_poses(moves, link)
        made[name] = _solids(name, link.parts, used)
        made.links[name] = (link.joint, link.body, (float(link.z[0]), float(link.z[1]), float(link.z[2])))
    sliding = {joint.name for joint in moves.joints() if joint.kind.name == "prismatic"}
    base = Base(moves, lines, gather_blocks(ends.stands, sliding, moves.sizes), np.array(mount.up))
    made["ground"] = _solids("ground", base.parts(), used)
    for pair in moves.rolling():
        made.may_touch(pair.wheel.body.name, pair.plane.body.name)
    made.along = made.space = True
    made.mount = (mount.kind, mount.up)
    return made


def link_poses(moves: Moves, link: Link) -> tuple[Array, Array]:
    """Return places (T, 3) and rotations (T, 3, 3) of the massless link of a joint."""
    joint = moves.m.joints[link.joint]
    first, second = (moves.world(marker.body.name, moves.place(marker))[:, 0] for marker in (joint.i, joint.j))
    if joint.kind.name == "universal":
        x, y = (moves.turned(marker.body.name, np.array(marker.axis)) for marker in (joint.i, joint.j))
        return first, np.stack([x, y, np.cross(x, y)], axis=2)
    x = (second - first) / np.linalg.norm(second - first, axis=1, keepdims=True)
    near = moves.turned(link.body, link.z)
    z = np.array([across(a, b) for a, b in zip(x, near, strict=True)])
    return first, np.stack([x, np.cross(z, x), z], axis=2)


def _materials(m: Any) -> dict[str, str]:
    """Return the material of each moving body: by its role."""
    from mbsd.drawing.look import colours_by_role

    words = colours_by_role(m)
    return {body: LINK if word == "silver" else f"{LINK}_{word}" for body, word in words.items()}


def _solids(body: str, parts: list[Part], used: set[str]) -> list[Solid]:
    """Return pieces with names of their own; files are named after them."""
    out = []
    for name, shape, material, holes in parts:
        word = name if body == "ground" else f"{body}_{name}"
        word = re.sub(r"[^A-Za-z0-9_]+", "_", word)
        word = word if word[0].isalpha() else f"part_{word}"
        free = word
        count = 2
        while free in used:
            free, count = f"{word}_{count}", count + 1
        used.add(free)
        out.append(Solid(free, shape, material, holes, fitted=True))
    return out
