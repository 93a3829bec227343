"""Bodies as parts.json describes them, from the solids that parts.py returns."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from msgspec import UNSET

from shared.contract import BodyParts, End, Held, Piece, Rolling
from shared.contract.materials import MATERIALS
from shared.contract.parts import Link
from shared.shapes.bodies import Bodies, Place
from shared.shapes.solid import Solid
from shared.shapes.units import metres
from shared.stage.errors import UserError, did_you_mean

if TYPE_CHECKING:
    from mechanisms.stages.parts.memory import KeptPieces


# Checks what ``parts()`` returned before anything is made of it.

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def refuse_unfit(name: str, bodies: Any) -> None:
    """Raise UserError unless ``bodies`` is a dict of lists of Solid with fit names and known materials."""
    if not isinstance(bodies, dict) or not bodies:
        raise UserError(f"{name}: parts() must return a dict of lists of Solid by body, not {type(bodies).__name__}")
    known: dict[str, str] = {}
    for body, solids in bodies.items():
        if not solids or not all(isinstance(solid, Solid) for solid in solids):
            raise UserError(
                f"{name}: parts()['{body}'] must be a list of one Solid or more; "
                "Bodies.leave_out (shared/shapes/bodies.py) names a body without any"
            )
        for solid in solids:
            if not NAME.fullmatch(solid.name):
                raise UserError(f"{name}: {body}: a solid is called '{solid.name}'; use letters, digits and _")
            if solid.name in known:
                raise UserError(
                    f"{name}: {known[solid.name]} and {body} both have a solid '{solid.name}'; "
                    "files are named after solids, so give one of them another name"
                )
            if solid.material not in MATERIALS:
                raise UserError(
                    f"{name}: {body}: {solid.name} is of '{solid.material}'; there is {', '.join(MATERIALS)}"
                    f"{did_you_mean(solid.material, MATERIALS)}"
                )
            known[solid.name] = body
    if isinstance(bodies, Bodies):
        _refuse_unknown(name, bodies)
        _refuse_unknown_pieces(name, bodies, known)


def _refuse_unknown(name: str, bodies: Bodies) -> None:
    """Pairs that touch have solids, bodies that are left out have none."""
    for body in sorted(bodies.left_out & bodies.keys()):
        raise UserError(f"{name}: parts() has solids of '{body}' and leaves it out; do one of the two")
    for pair in sorted(bodies.touching):
        for body in pair:
            if body not in bodies:
                raise UserError(
                    f"{name}: may_touch{pair} names '{body}', which has no solids; there is: {', '.join(bodies)}"
                    f"{did_you_mean(body, bodies)}"
                )
    for rod in sorted(bodies.rods):
        if rod not in bodies:
            raise UserError(
                f"{name}: join_places names '{rod}', which has no solids; there is: {', '.join(bodies)}"
                f"{did_you_mean(rod, bodies)}"
            )


def _refuse_unknown_pieces(name: str, bodies: Bodies, home: dict[str, str]) -> None:
    """Pairs of solids that touch are there, and are of two bodies; ``home`` is the body of each solid."""
    for pair in sorted(bodies.pieces_touching):
        for solid in pair:
            if solid not in home:
                raise UserError(
                    f"{name}: pieces_may_touch{pair} names '{solid}', which is no solid; there is: "
                    f"{', '.join(home)}{did_you_mean(solid, home)}"
                )
        if home[pair[0]] == home[pair[1]]:
            raise UserError(
                f"{name}: pieces_may_touch{pair} names two solids of '{home[pair[0]]}', which are not compared anyway; "
                "name solids of two bodies"
            )


# One body as parts.json has it: its solids checked, meshed and weighed, and the bytes of their files.


class Measured(NamedTuple):
    """Numbers of masses beside their centre and inertia in the plane."""

    along: bool = False
    """z of the solids is that of the model, so masses have it, too."""
    space: bool = False
    """The whole inertia, of a mechanism in space."""


PLANAR = Measured()


def described_body(
    name: str,
    body: str,
    solids: list[Any],
    files: dict[str, bytes],
    places: tuple[Place, Place] | None,
    along: Measured = PLANAR,
    kept: KeptPieces | None = None,
    done: Callable[[], object] = bool,
    unsound: dict[str, UserError] | None = None,
    link: tuple[str, str, tuple[float, float, float]] | None = None,
) -> BodyParts:
    """Describe a body and add its files to ``files``; ``places`` are those that a rod joins.

    ``along``: z of the solids is that of the model, so masses have it, too. Pieces that are ``kept`` are not made
    again; ``done`` is called after each piece. A solid that nobody shaped and that is refused becomes a pane of glass,
    and is entered with its error into ``unsound`` where that is given. ``link``: joint in space whose massless link it
    is, with the body and direction of its z axis.

    Raises UserError naming the solid that is refused.
    """
    from mechanisms.stages.parts.meshes import combined

    pieces: dict[str, Piece] = {}
    for solid in solids:
        try:
            pieces[solid.name] = _piece(name, body, solid, files, along, kept)
        except UserError as error:
            if unsound is None or not solid.fitted:
                raise
            from mechanisms.stages.automatic.glass import pane_for

            unsound[solid.name] = error
            pieces[solid.name] = _piece(name, body, pane_for(solid), files, along)
        done()
    main = pieces[solids[0].name]
    mass = combined(piece.mass for piece in pieces.values() if not piece.dressing)
    own = UNSET if link is None else Link(joint=link[0], body=link[1], z=link[2])
    return BodyParts(pieces=pieces, mass=mass, z=(sum(main.z_range)) / 2, spans=places and spans(places), link=own)


def spans(places: tuple[Place, Place]) -> tuple[End, End]:
    """Return the places (mm) that a rod joins, as parts.json has them."""
    first, second = (End(body=body, x=metres(x), y=metres(y)) for body, x, y in places)
    return first, second


def _piece(
    name: str, body: str, solid: Any, files: dict[str, bytes], along: Measured, kept: KeptPieces | None = None
) -> Piece:
    """Check one solid, add its files to ``files``, and describe it."""
    from mechanisms.stages.parts.memory import Kept
    from mechanisms.stages.parts.meshes import OF_ITSELF, check_mesh, mass_of, only_solid
    from mechanisms.stages.parts_files import read_mesh, step_bytes, stl_bytes
    from shared.shapes.facets import volume_of
    from shared.shapes.kernel import is_of_kernel

    where = f"{name}: {body}: {solid.name}"
    if not callable(getattr(solid.shape, "solids", None)):
        raise UserError(
            f"{where}: its shape is of type {type(solid.shape).__name__}; Solid takes a cadquery.Workplane "
            "(cq.Workplane(obj=shape) makes one of a shape)"
        )
    try:
        shape = only_solid(solid.shape, where, solid.fitted)
        key = kept.key(shape, solid, along) if kept else ""
        known = kept.get(key) if kept else None
        if known is not None:
            files |= {known.piece.stl: known.stl, known.piece.step: known.step}
            return known.piece
        step = step_bytes(shape, solid.name)  # before the mesh, which the shape would carry along
        stl = stl_bytes(shape, solid.tolerance)
    except Exception as error:
        if not is_of_kernel(error):
            raise
        remedy = "look at its last fillet, chamfer or cut: make it smaller, or apply it earlier"
        raise UserError(
            f"{where}: the CAD kernel cannot mesh or write this solid ({type(error).__name__}: {error}); "
            f"{OF_ITSELF if solid.fitted else remedy}"
        ) from error
    mesh = read_mesh(stl)
    check_mesh(mesh, volume_of(shape), solid.through_holes, where, solid.fitted)
    files[f"{solid.name}.stl"] = stl
    files[f"{solid.name}.step"] = step
    piece = Piece(
        material=solid.material,
        stl=f"{solid.name}.stl",
        step=f"{solid.name}.step",
        mass=mass_of(shape, MATERIALS[solid.material].density, *along),
        z_range=(metres(float(mesh.bounds[0][2])), metres(float(mesh.bounds[1][2]))),
        triangles=len(mesh.faces),
        stl_sha256=hashlib.sha256(stl).hexdigest(),
        rolls=_rolling(solid.rolls),
        holds={hold.force: Held(z=metres(hold.z), radius=metres(hold.radius)) for hold in solid.holds},
        buy=solid.buy,
        dressing=solid.dressing,
    )
    if kept:
        kept.add(key, Kept(piece, stl, step))
    return piece


def _rolling(roll: Any) -> Rolling | None:
    if roll is None:
        return None
    x, y, radius = (metres(length) for length in (roll.x, roll.y, roll.radius))
    return Rolling(joint=roll.joint, x=x, y=y, radius=radius, marks=roll.marks)
