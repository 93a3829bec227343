"""The ``parts`` stage: mechanisms/<name>/parts.py, or the model by itself, becomes STL, STEP and parts.json.

It runs again only if something changed that the solids follow from: parts.py and what it imports or reads, the part
library, the densities, CadQuery, or a parameter that ``parts()`` reads. mechanism.py itself counts only where parts.py
uses more of it than the parameters' values; and where there is no parts.py, because then the solids follow from the
model and its motion (mechanisms/automatic). A file whose bytes would be the same is not touched.
"""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mechanisms.stages.loading.inputs import Inputs, observed
from mechanisms.stages.loading.loading import author_code, has, load, package_of, params
from mechanisms.stages.loading.recording import recording
from mechanisms.stages.parts.plain_values import plain_text
from mechanisms.stages.parts.traced_params import fields_of, traced
from shared.contract import BodyParts, End, Held, Parts, Piece, Provenance, Rolling, write_parts
from shared.contract.materials import MATERIALS
from shared.shapes.units import metres
from shared.stage.console import say, warn
from shared.stage.errors import UserError
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out, mechanism_folder
from shared.stage.stages import Stage, contract_sources, key_of, versions

if TYPE_CHECKING:
    from shared.shapes.bodies import Place

_STAGES = ROOT / "mechanisms" / "stages"
_STAGE = ("stage", "returned_parts", "mass_properties", "mesh_check", "traced_params")
SOURCES = [
    ROOT / "shared" / "shapes",
    _STAGES / "parts_files.py",
    *(_STAGES / "parts" / f"{name}.py" for name in _STAGE),
    *contract_sources(),
]
_MOTION = ("bare_motion", "solving", "refined_times", "masses", "estimated_masses")
_AUTOMATIC = ("automatic", "parts/parts_by_themselves.py", "loading/variants.py")
AUTOMATIC = [
    *SOURCES,
    *(_STAGES / name for name in _AUTOMATIC),
    *(_STAGES / "solve" / f"{name}.py" for name in _MOTION),
]
"""Sources of parts without a parts.py."""
PACKAGES = ("cadquery", "cadquery-ocp", "numpy", "python-sat", "trimesh")


def run(name: str) -> None:
    """Make the parts of mechanism ``name``, if anything they follow from has changed.

    Raises UserError naming the solid, the number and the remedy if a solid is refused; what was there stays.
    """
    out = Out(name)
    before = set(sys.modules)
    with recording() as recorder:
        given = params(out.name)
    by_itself = not has(out.name, "parts")
    if _is_fresh(out, given, by_itself):
        say("parts", f"{out.name}: nothing to do")
        return
    from mechanisms.stages.loading.loaded_files import loaded_inputs

    bodies, reads, inputs = _build(out.name, given)
    if by_itself or _more_than_values(out.name, given, reads):
        mechanism = loaded_inputs(mechanism_folder(name) / "mechanism.py", package_of(out.name), before)
        inputs = inputs.joined(mechanism).joined(recorder.inputs())
    key = _key(given, reads, inputs, by_itself)
    files: dict[str, bytes] = {}
    rods = getattr(bodies, "rods", {})
    described = {body: _body(out.name, body, solids, files, rods.get(body)) for body, solids in bodies.items()}
    document = Parts(
        mechanism=out.name,
        provenance=Provenance(inputs=key, versions=versions(*PACKAGES)),
        bodies=described,
        without_solids=sorted(getattr(bodies, "left_out", ())),
        may_touch=sorted(getattr(bodies, "touching", ())),
        pieces_may_touch=sorted(getattr(bodies, "pieces_touching", ())),
    )
    written = _write(out, files, document)
    Stage(out, "parts", key, [out.parts, *(out.parts_folder / file for file in files)]).done(
        parameters=reads, inputs=inputs.names()
    )
    say("parts", _summary(out.name, document, written))


def are_current(name: str) -> bool:
    """Whether the parts that are there are those of the mechanism as it is. Raises UserError for one without Params."""
    out = Out(name)
    return _is_fresh(out, params(out.name), not has(out.name, "parts"))


def run_or_none(name: str) -> None:
    """The same for what needs no parts, motion and plots: where a mechanism without a parts.py has none, that is
    told.
    """
    out = Out(name)
    try:
        run(name)
    except UserError as error:
        if has(out.name, "parts"):
            raise
        out.parts.unlink(missing_ok=True)  # of the model as it was
        warn("parts", f"{error}; until then there are none")


def _is_fresh(out: Out, given: Any, by_itself: bool) -> bool:
    notes = Stage(out, "parts", "", []).notes()
    reads, inputs = notes.get("parameters"), observed(notes.get("inputs"))
    if not isinstance(reads, list) or not inputs:
        return False
    return Stage(out, "parts", _key(given, reads, inputs, by_itself), [out.parts]).is_fresh()


def _key(given: Any, reads: list[str], inputs: Inputs, by_itself: bool = False) -> str:
    """Hash of all that the parts follow from; ``reads`` are the attributes of Params that parts() reads."""
    fields = fields_of(given)
    values = {read: plain_text(fields[read]) for read in reads if read in fields}
    densities = {material: MATERIALS[material].density for material in sorted(MATERIALS)}
    sources = sources_hash(*(AUTOMATIC if by_itself else SOURCES))
    return key_of(sources, by_itself, versions(*PACKAGES), densities, values, inputs.digest())


def _more_than_values(name: str, given: Any, reads: list[str]) -> bool:
    """Whether the parts follow from more of mechanism.py than from the values of parameters.

    A property or method of Params can compute anything, a value may have no text that tells it, and parts.py or what it
    imports may use other names of mechanism.py.
    """
    from mechanisms.stages.loading.loaded_files import author_files
    from mechanisms.stages.parts.params_use import only_annotates

    fields, folder, package = fields_of(given), mechanism_folder(name), package_of(name)
    if any(read not in fields or plain_text(fields[read]) is None for read in reads):
        return True
    return not only_annotates(
        author_files(folder / "parts.py", package, folder / "mechanism.py"), f"{package}.mechanism"
    )


def _build(name: str, given: Any) -> tuple[dict[str, list[Any]], list[str], Inputs]:
    """The solids by body, the names that parts() read from its parameters, and what parts.py was made of and read."""
    from mechanisms.stages.loading.loaded_files import loaded_inputs
    from mechanisms.stages.parts.cad_reads import told_of_cad_files
    from mechanisms.stages.parts.returned_parts import refuse_unfit

    if not has(name, "parts"):
        from mechanisms.stages.parts.parts_by_themselves import solids_of

        return solids_of(name), [], Inputs()
    stand_in, seen = traced(given)
    folder, before = mechanism_folder(name), set(sys.modules)
    with recording() as recorder, told_of_cad_files(recorder):
        module = load(name, "parts")
        with author_code(name):
            bodies = module.parts(stand_in)
    loaded = loaded_inputs(folder / "parts.py", package_of(name), before, leave_out=folder / "mechanism.py")
    refuse_unfit(name, bodies)
    return bodies, sorted(seen), loaded.joined(recorder.inputs())


def _body(
    name: str, body: str, solids: list[Any], files: dict[str, bytes], places: tuple[Place, Place] | None
) -> BodyParts:
    from mechanisms.stages.parts.mass_properties import combined

    pieces = {solid.name: _piece(name, body, solid, files) for solid in solids}
    main = pieces[solids[0].name]
    mass = combined(piece.mass for piece in pieces.values())
    return BodyParts(pieces=pieces, mass=mass, z=(sum(main.z_range)) / 2, spans=places and spans(places))


def spans(places: tuple[Place, Place]) -> tuple[End, End]:
    """The places (mm) that a rod joins, as parts.json has them."""
    first, second = (End(body=body, x=metres(x), y=metres(y)) for body, x, y in places)
    return first, second


def _piece(name: str, body: str, solid: Any, files: dict[str, bytes]) -> Piece:
    """Check one solid, add its files to ``files``, and describe it."""
    from mechanisms.stages.loading.author_errors import is_of_kernel
    from mechanisms.stages.parts.mass_properties import mass_of
    from mechanisms.stages.parts.mesh_check import check_mesh, only_solid
    from mechanisms.stages.parts_files import read_mesh, step_bytes, stl_bytes

    where = f"{name}: {body}: {solid.name}"
    if not callable(getattr(solid.shape, "solids", None)):
        raise UserError(
            f"{where}: its shape is of type {type(solid.shape).__name__}; Solid takes a cadquery.Workplane "
            "(cq.Workplane(obj=shape) makes one of a shape)"
        )
    try:
        shape = only_solid(solid.shape, where)
        step = step_bytes(shape, solid.name)  # before the mesh, which the shape would carry along
        stl = stl_bytes(shape, solid.tolerance)
    except Exception as error:
        if not is_of_kernel(error):
            raise
        raise UserError(
            f"{where}: the CAD kernel cannot mesh or write this solid ({type(error).__name__}: {error}); look at its "
            "last fillet, chamfer or cut: make it smaller, or apply it earlier"
        ) from error
    mesh = read_mesh(stl)
    check_mesh(mesh, shape.Volume(), solid.through_holes, where)
    files[f"{solid.name}.stl"] = stl
    files[f"{solid.name}.step"] = step
    return Piece(
        material=solid.material,
        stl=f"{solid.name}.stl",
        step=f"{solid.name}.step",
        mass=mass_of(shape, MATERIALS[solid.material].density),
        z_range=(metres(float(mesh.bounds[0][2])), metres(float(mesh.bounds[1][2]))),
        triangles=len(mesh.faces),
        stl_sha256=hashlib.sha256(stl).hexdigest(),
        rolls=_rolling(solid.rolls),
        holds={hold.force: Held(z=metres(hold.z), radius=metres(hold.radius)) for hold in solid.holds},
        buy=solid.buy,
    )


def _rolling(roll: Any) -> Rolling | None:
    if roll is None:
        return None
    x, y, radius = (metres(length) for length in (roll.x, roll.y, roll.radius))
    return Rolling(joint=roll.joint, x=x, y=y, radius=radius, marks=roll.marks)


def _write(out: Out, files: dict[str, bytes], document: Parts) -> int:
    """Write what differs from what is there, remove what no solid makes any more; the number of files written.

    parts.json is written last, so it never names a file that is not there.
    """
    written = 0
    for file, content in files.items():
        path = out.parts_folder / file
        if not path.is_file() or path.read_bytes() != content:
            write_bytes(path, content)
            written += 1
    write_parts(out.parts, document)
    for path in _leftovers(out.parts_folder, files):
        path.unlink()
    return written


def _leftovers(folder: Path, files: dict[str, bytes]) -> list[Path]:
    return [path for path in sorted(folder.iterdir()) if path.suffix in (".stl", ".step") and path.name not in files]


def _summary(name: str, document: Parts, written: int) -> str:
    pieces = [piece for body in document.bodies.values() for piece in body.pieces.values()]
    moving = sum(body.mass.mass for key, body in document.bodies.items() if key != "ground")
    triangles = sum(piece.triangles for piece in pieces)
    return (
        f"{name}: {len(pieces)} solids of {len(document.bodies)} bodies, {moving:.3f} kg moving, "
        f"{triangles} triangles, {written} files written"
    )
