"""One body as parts.json has it: its solids checked, meshed and weighed, and the bytes of their files."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

from shared.contract import BodyParts, End, Held, Piece, Rolling
from shared.contract.materials import MATERIALS
from shared.shapes.units import metres
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechanisms.stages.parts.kept_pieces import KeptPieces
    from shared.shapes.bodies import Place


def described_body(
    name: str,
    body: str,
    solids: list[Any],
    files: dict[str, bytes],
    places: tuple[Place, Place] | None,
    along: bool = False,
    kept: KeptPieces | None = None,
    done: Callable[[], object] = bool,
) -> BodyParts:
    """Describe a body and add its files to ``files``; ``places`` are those that a rod joins. ``along``: z of the solids
    is that of the model, so masses have it, too. Pieces that are ``kept`` are not made again; ``done`` is called
    after each piece.

    Raises UserError naming the solid that is refused.
    """
    from mechanisms.stages.parts.mass_properties import combined

    pieces: dict[str, Piece] = {}
    for solid in solids:
        pieces[solid.name] = _piece(name, body, solid, files, along, kept)
        done()
    main = pieces[solids[0].name]
    mass = combined(piece.mass for piece in pieces.values() if not piece.dressing)
    return BodyParts(pieces=pieces, mass=mass, z=(sum(main.z_range)) / 2, spans=places and spans(places))


def spans(places: tuple[Place, Place]) -> tuple[End, End]:
    """The places (mm) that a rod joins, as parts.json has them."""
    first, second = (End(body=body, x=metres(x), y=metres(y)) for body, x, y in places)
    return first, second


def _piece(
    name: str, body: str, solid: Any, files: dict[str, bytes], along: bool, kept: KeptPieces | None = None
) -> Piece:
    """Check one solid, add its files to ``files``, and describe it."""
    from mechanisms.stages.parts.kept_pieces import Kept
    from mechanisms.stages.parts.mass_properties import mass_of
    from mechanisms.stages.parts.mesh_check import OF_ITSELF, check_mesh, only_solid
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
        mass=mass_of(shape, MATERIALS[solid.material].density, along),
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
