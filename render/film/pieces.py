"""Pieces of a picture, and how far they are lifted as a machine comes apart."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np

from render.film.scene import PieceSpec, SurfaceSpec
from render.film.section import WHOLE, cuts_of
from render.film.solids import Array, prism, read_corners
from shared.contract import AnyMotion, Motion3, Parts, Piece
from shared.contract.materials import MATERIALS
from shared.contract.parts import Vector, Z
from shared.contract.shot import Shot, Surface
from shared.stage.errors import UserError, did_you_mean
from shared.stage.files import file_hash

# The solids of a film: which there are, how they look, and that they are those of its motion.

COLOURED, KEPT = 0.05, 0.06
"""Difference of linear RGB from which on a surface is coloured, and the part of its own colour that it keeps."""
TINT, PANE = 0.6, 0.06
"""Part of its colour that a transparent piece keeps, and its roughness."""
GREY, DARKEST = 0.9, 0.14
"""Lightness of a coloured surface beside arrows, as a part of its own, and the least."""


def piece_specs(parts: Parts, shot: Shot, folder: Path, motion: AnyMotion | None = None) -> list[PieceSpec]:
    """Return all solids of ``folder``, as far as the shot's section leaves them.

    ``motion`` gives the poses of bodies that a section names.

    Raises UserError for a material that is not known, and for a section that cuts nothing.
    """
    if isinstance(motion, Motion3):
        _refuse_section(parts.mechanism, shot)
        cuts = {}
    else:
        cuts = cuts_of(parts, shot.section, folder, motion)
    return [
        PieceSpec(
            body=body,
            name=name,
            stl=str((folder / piece.stl).resolve()),
            sha256=piece.stl_sha256,
            surface=_surface(parts.mechanism, shot, body, name, piece, folder / piece.stl),
            turns_about=(piece.rolls.x, piece.rolls.y) if piece.rolls else None,
            cut=cuts.get((body, name), WHOLE).planes,
            fixed=cuts.get((body, name), WHOLE).fixed,
        )
        for body, name, piece in _pieces(parts)
        if not cuts.get((body, name), WHOLE).gone
    ]


def refuse_mismatch(motion: AnyMotion, parts: Parts, folder: Path) -> None:
    """Raise UserError unless the solids' bodies are the motion's and the files those described.

    The ground is left out.
    """
    name = motion.mechanism
    if parts.mechanism != name:
        raise UserError(f"parts.json is of {parts.mechanism}, data.json of {name}; make both again")
    unknown = [body for body in parts.bodies if body not in {*motion.bodies, "ground"}]
    if unknown:
        raise UserError(
            f"{name}: parts.json has solids for {', '.join(unknown)}, which do not move in data.json; "
            f"it has: {', '.join(motion.bodies)}"
        )
    if not any(True for _ in _pieces(parts)):
        raise UserError(f"{name}: parts.json has no solids, so there is nothing to see; make the parts again")
    for body, piece_name, piece in _pieces(parts):
        known = [*motion.joints, *getattr(motion, "contacts", {})]
        if piece.rolls is not None and piece.rolls.joint not in known:
            raise UserError(
                f"{name}: piece {body}/{piece_name} rolls in joint '{piece.rolls.joint}', which data.json has not; "
                f"it has: {', '.join(known) or 'none'}{did_you_mean(piece.rolls.joint, known)}"
            )
        if file_hash(folder / piece.stl) != piece.stl_sha256:
            raise UserError(f"{name}: {piece.stl} is not the file parts.json describes; make the parts again")


def _refuse_section(mechanism: str, shot: Shot) -> None:
    if shot.section:
        raise UserError(
            f"{mechanism}: shot.section cuts mechanisms in the plane; leave it out, or say which parts are transparent"
        )


def _pieces(parts: Parts) -> Iterator[tuple[str, str, Piece]]:
    return ((body, name, piece) for body, solids in parts.bodies.items() for name, piece in solids.pieces.items())


ROUND, SIDES = 0.6, 20
"""Part of its rim that makes a piece round, and the least number of its sides."""


def axis_of(outline: Array) -> tuple[float, float] | None:
    """Return the middle of the circle that most of a convex outline (2 n, 2) is on: such metal is turned.

    None for an outline that is not a circle. The circle is that of least squares, once more without what is off it.
    """
    rim = outline[: len(outline) // 2]
    if len(rim) < SIDES:
        return None
    on_it, centre, radius = np.full(len(rim), True), np.zeros(2), 0.0
    for _ in range(2):
        rows = np.column_stack([rim[on_it], np.ones(int(on_it.sum()))])
        u, v, w = np.linalg.lstsq(rows, (rim[on_it] ** 2).sum(axis=1), rcond=None)[0]
        centre = np.array([u, v]) / 2
        radius = math.sqrt(max(float(w + centre @ centre), 0.0))
        off = np.abs(np.hypot(*(rim - centre).T) - radius)
        on_it = off < 0.01 * radius
        if on_it.sum() < SIDES:
            return None
    sides = np.linalg.norm(np.roll(rim, -1, axis=0) - rim, axis=1)
    between = (rim + np.roll(rim, -1, axis=0)) / 2 - centre
    arc = on_it & np.roll(on_it, -1) & (np.hypot(*between.T) > 0.97 * radius)  # a chord has its ends on the circle
    share = float(sides[arc].sum() / max(sides.sum(), 1e-12))
    return (round(float(centre[0]), 6), round(float(centre[1]), 6)) if share >= ROUND else None


def _surface(mechanism: str, shot: Shot, body: str, name: str, piece: Piece, stl: Path) -> SurfaceSpec:
    chosen = _chosen(mechanism, shot, body, name, piece)
    if chosen.finish == "brushed":
        chosen = msgspec.structs.replace(chosen, turned=axis_of(prism(read_corners(stl))[:, :2]))
    if shot.transparent and {body, f"{body}/{name}"} & set(shot.transparent):
        chosen = as_pane(chosen)
    return neutral(chosen) if shot.show else chosen


def as_pane(surface: SurfaceSpec) -> SurfaceSpec:
    """Return a pane of glass in a light tint of the surface's colour."""
    red, green, blue = (TINT * channel + (1 - TINT) for channel in surface.colour)
    return SurfaceSpec(colour=(red, green, blue), finish="glass", roughness=PANE)


def neutral(surface: SurfaceSpec) -> SurfaceSpec:
    """Return the surface as grey as it is light.

    Beside arrows no body has a colour: signal colours belong to quantities.
    """
    light = sum(part * channel for part, channel in zip((0.2126, 0.7152, 0.0722), surface.colour, strict=True))
    grey = GREY * max(light, DARKEST) if max(surface.colour) - min(surface.colour) > COLOURED else light
    red, green, blue = (KEPT * channel + (1 - KEPT) * grey for channel in surface.colour)
    return msgspec.structs.replace(surface, colour=(red, green, blue))


def _chosen(mechanism: str, shot: Shot, body: str, name: str, piece: Piece) -> SurfaceSpec:
    chosen = shot.materials.get(f"{body}/{name}", shot.materials.get(body, piece.material))
    if isinstance(chosen, Surface):
        return SurfaceSpec(colour=chosen.colour, finish=chosen.finish, roughness=chosen.roughness)
    if chosen not in MATERIALS:
        raise UserError(f"{mechanism}: piece {body}/{name} is of '{chosen}'; known: {', '.join(MATERIALS)}")
    material = MATERIALS[chosen]
    return SurfaceSpec(colour=material.colour, finish=material.finish, roughness=material.roughness)


# How a machine comes apart: which piece is lifted along which axis, in which order, how far; from parts.json alone.
#
# Pieces of a planar machine are put together along the normal of its plane, the lowest first. A piece belongs to the
# layer of its middle: a pin between two links is put into the lower one before the upper one is put on it.

SAME = 0.03
"""Pieces whose middles are nearer than this part of the height of the stack are of one layer."""
STEP = 0.085
"""Distance from one layer to the next, as a part of the machine's size, ..."""
MOST = 0.6
"""... and all of them together."""


class Lift(NamedTuple):
    """One piece of an exploded machine."""

    body: str
    piece: str
    order: int
    """Order in which it is put together, from 0 on; pieces of one layer have the same."""
    axis: Vector
    """Unit vector of the frame of ground along which it is lifted."""
    distance: float
    """m"""

    @property
    def name(self) -> str:
        """``body/piece``."""
        return f"{self.body}/{self.piece}"


def exploded(parts: Parts, size: float) -> list[Lift]:
    """Return all pieces in the order in which they are put together; ``size`` (m) is that of the machine.

    What is lowest stays where it is. A machine of a single layer comes apart nowhere: all its distances are 0.
    """
    middles = sorted(
        (sum(piece.z_range) / 2, body, name)
        for body, solids in parts.bodies.items()
        for name, piece in solids.pieces.items()
    )
    if not middles:
        return []
    apart, layers, last = SAME * (middles[-1][0] - middles[0][0]), [], -1e300
    for middle, _, _ in middles:
        layers.append((layers[-1] if layers else 0) + (bool(layers) and middle - last > apart))
        last = middle
    step = size * min(STEP, MOST / max(layers[-1], 1))
    return [Lift(body, name, layer, Z, step * layer) for layer, (_, body, name) in zip(layers, middles, strict=True)]
