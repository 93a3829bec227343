"""Bodies in space: ends joined by rods, frames or plates, and discs and balls on them."""

from __future__ import annotations

from itertools import pairwise

import cadquery as cq
import numpy as np
from scipy.spatial import ConvexHull

from mbsd.spatial.model.body import Body
from mechanisms.stages.automatic.space import round as shapes
from mechanisms.stages.automatic.space.moves import MM, Array, Sizes
from mechanisms.stages.automatic.space.pieces import End, Line, Part
from mechanisms.stages.automatic.space.round import across, unit
from mechanisms.stages.automatic.space.wheels import HUB, Rim, disc_half, disc_solid

FLAT = 0.6
"""Ends lie in a plane if none is farther from it, in rods."""
MANY = 4
"""Ends from which on a plate holds them."""
BOB = 2.6
"""Radius of the ball that stands for a mass at the end of a rod, in rods."""


def body_parts(
    body: Body, ends: list[End], sizes: Sizes, material: str, rim: Rim | None = None
) -> tuple[list[Part], list[Line]]:
    """Return the pieces of a body, the main one first, and lines for looking whether it meets others (mm).

    ``rim`` is that of a disc that rolls.
    """
    solids: list[cq.Shape] = []
    lines: list[Line] = []
    shape = body.shape
    nodes = [end.node for end in ends]
    radius = sizes.rod
    if shape is not None and shape.kind == "rod":
        own = MM * shape.radius if shape.radius > 0.0 else sizes.rod
        rods = _along_x(nodes, MM * shape.length, own, sizes)
        radius = own
    else:
        centre = MM * np.array(body.com) if shape is None else np.zeros(3)
        bush = next((end.node for end in ends if end.bush is not None), None)
        rods = _joined(nodes, centre, shape is not None, sizes, bush)
        portal = _portal(ends, sizes) if shape is None else []
        if portal:
            rods = portal
        elif len(nodes) >= MANY and shape is None:
            plate = _plate(nodes, sizes)
            if plate is not None:
                solids, rods = [plate], []
                lines += [(np.mean(nodes, axis=0), node, sizes.rod) for node in nodes]
    solids += [shapes.rod(a, b, radius) for a, b in rods]
    lines += [_inset(a, b, radius, radius - sizes.rod) for a, b in rods]
    added, extra = _carried(body, nodes, rods, sizes, rim)
    solids += added
    for end in ends:
        solids += end.adds
        lines += end.lines
    cuts = [cut for end in ends for cut in end.cuts]
    holes = sum(end.holes for end in ends)
    main = ("body", shapes.fused(solids or [shapes.ball(np.zeros(3), 3 * sizes.rod)], cuts), material, holes)
    parts = [main, *extra]
    for end in ends:
        parts += [(f"{name}_{end.joint}", *rest) for name, *rest in end.parts]
    return parts, lines + _rim(body)


def _inset(a: Array, b: Array, radius: float, by: float) -> Line:
    """Return the line of a rod; that of a thick one is shorter at both ends, as its round ends reach out."""
    way = b - a
    part = min(max(by, 0.0) / float(np.linalg.norm(way)), 0.5)
    return a + part * way, b - part * way, radius


def _along_x(nodes: list[Array], length: float, radius: float, sizes: Sizes) -> list[tuple[Array, Array]]:
    """Return the rod of a body along x, as far as its ends are, and rods from it to ends aside."""
    x = np.eye(3)[0]
    near = [node for node in nodes if np.hypot(node[1], node[2]) <= 1.5 * sizes.rod]
    places = [float(node[0]) for node in near]
    free = [at for at in (0.0, length) if all(abs(at - place) > 6.0 * sizes.rod for place in places)]
    low, high = min(places + free), max(places + free)
    out = [(low * x, high * x)] if high - low > radius else []
    for node in nodes:
        if np.hypot(node[1], node[2]) > 1.5 * sizes.rod:
            out.append((min(max(float(node[0]), low), high) * x, node))
    return out


def _joined(
    nodes: list[Array], centre: Array, carries: bool, sizes: Sizes, bush: Array | None
) -> list[tuple[Array, Array]]:
    """Return straight rods that join the ends of a body; many meet in its bush, if it has one."""
    if len(nodes) == 2 and not carries:
        pairs = [(nodes[0], nodes[1])]
    elif len(nodes) <= 1 or carries:
        pairs = [(node, centre) for node in nodes]
    else:
        pairs = [(np.mean(nodes, axis=0) if bush is None else bush, node) for node in nodes]
    return [(a, b) for a, b in pairs if np.linalg.norm(b - a) > 0.05 * sizes.rod]


def _portal(ends: list[End], sizes: Sizes) -> list[tuple[Array, Array]]:
    """Return the rods of a frame round a shaft: two bushes and a beam beside their axis."""
    bushes = [end for end in ends if end.bush is not None]
    if len(bushes) < 2:
        return []
    start, axis = bushes[0].node, bushes[0].bush
    assert axis is not None
    aside = [end.node - start - (end.node - start) @ axis * axis for end in ends]
    if any(np.linalg.norm(aside[ends.index(bush)]) > 0.1 * sizes.rod for bush in bushes[1:]):
        return []
    rise = max(aside, key=lambda way: float(np.linalg.norm(way)))
    if np.linalg.norm(rise) < 6.0 * sizes.rod:
        return []
    places = sorted(float((bush.node - start) @ axis) for bush in bushes)
    beam = [start + place * axis + rise for place in (places[0], places[-1])]
    rods = [(beam[0], beam[1]), *((bush.node, bush.node + rise) for bush in bushes)]
    for end in ends:
        if end.bush is None:
            near = start + float(np.clip((end.node - start) @ axis, places[0], places[-1])) * axis + rise
            if np.linalg.norm(end.node - near) > 0.05 * sizes.rod:
                rods.append((near, end.node))
    return rods


def _plate(nodes: list[Array], sizes: Sizes) -> cq.Shape | None:
    """Return a plate with round corners through many ends, or None where they lie in no plane or on a line."""
    middle = np.mean(nodes, axis=0)
    _, spread, axes = np.linalg.svd(np.array(nodes) - middle)
    normal = axes[2]
    if spread[1] < sizes.rod or max(abs((node - middle) @ normal) for node in nodes) > FLAT * sizes.rod:
        return None
    x = across(normal)
    flat = (np.array(nodes) - middle) @ np.column_stack([x, np.cross(normal, x)])
    corners = [(float(u), float(v)) for u, v in flat[ConvexHull(flat).vertices]]
    half = 0.9 * sizes.rod
    plane = cq.Plane(origin=tuple(middle - half * normal), xDir=tuple(x), normal=tuple(normal))
    outline = cq.Workplane(plane).polyline(corners).close().offset2D(1.6 * sizes.rod)
    return outline.extrude(2.0 * half).val()  # pyright: ignore[reportReturnType]


def _carried(
    body: Body, nodes: list[Array], rods: list[tuple[Array, Array]], sizes: Sizes, rim: Rim | None
) -> tuple[list[cq.Shape], list[Part]]:
    """Return solids and pieces on a body's rods: a disc, a ball, or a ball for a mass beyond them."""
    shape, x, zero = body.shape, np.eye(3)[0], np.zeros(3)
    if shape is not None and shape.kind == "disc":
        wheel, half = disc_solid(body, sizes, rim), disc_half(body, sizes)
        on_axis = all(np.hypot(node[1], node[2]) < 0.1 * sizes.rod for node in nodes)
        if not (nodes and on_axis):
            return [wheel], []
        hub = min(2.2 * sizes.rod, 0.8 * MM * shape.radius)
        bored = shapes.fused([wheel], [shapes.disc(zero, x, hub, half + 1.0)])
        return [shapes.disc(zero, x, hub, half + HUB * sizes.rod)], [("disc", bored, "brass", 1)]
    if shape is not None and shape.kind == "ball":
        return [shapes.ball(zero, MM * shape.radius, unit(nodes[0]) if nodes and np.linalg.norm(nodes[0]) else x)], []
    com = MM * np.array(body.com)
    start = _start_of_bob(body, com, nodes, rods, sizes)
    if start is None:
        return [], []
    pole = unit(com - start)
    held = [shapes.ball(com, 1.2 * sizes.rod, pole), shapes.rod(start, com, sizes.rod)]
    return held, [("bob", shapes.fused([shapes.ball(com, BOB * sizes.rod, pole)], held), "brass", 0)]


def _start_of_bob(
    body: Body, com: Array, nodes: list[Array], rods: list[tuple[Array, Array]], sizes: Sizes
) -> Array | None:
    """Return where the rod to a mass beyond a body's rods begins; None if there is no such mass."""
    if body.shape is not None or not nodes:
        return None
    start = min(nodes, key=lambda node: float(np.linalg.norm(com - node)))
    if len(nodes) > 1:
        gaps = [_distance(com, a, b) for a, b in rods]
        if body.mass == 0.0 or len(nodes) >= MANY or min(gaps, default=np.inf) < 2.0 * BOB * sizes.rod:
            return None
    return start if np.linalg.norm(com - start) > sizes.rod else None


def _distance(point: Array, a: Array, b: Array) -> float:
    """Return the distance of a point from a rod."""
    way = b - a
    return float(np.linalg.norm(point - a - np.clip((point - a) @ way / (way @ way), 0.0, 1.0) * way))


def _rim(body: Body) -> list[Line]:
    """Return lines round a disc or ball."""
    shape = body.shape
    if shape is None or shape.kind == "rod":
        return []
    if shape.kind == "ball":
        return [(np.zeros(3), np.zeros(3), MM * shape.radius)]
    half = max(0.5 * MM * shape.length, 0.05 * MM * shape.radius)
    y = across(np.eye(3)[0])
    z = np.cross(np.eye(3)[0], y)
    turn = np.linspace(0.0, 2.0 * np.pi, 17)
    rim = (MM * shape.radius - half) * (np.outer(np.cos(turn), y) + np.outer(np.sin(turn), z))
    return [(a, b, half) for a, b in pairwise(rim)]
