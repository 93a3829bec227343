"""The stage ``parts``: a parts.py, or the model alone, becomes STL, STEP and parts.json.

The solids are STL and STEP files, which parts.json describes. It runs again only if something changed that the solids
follow from: parts.py and what it imports or reads, the part library, the densities, CadQuery, a parameter that
``parts()`` reads, or ``mount`` of shot.py, whose other fields count for nothing here. mechanism.py itself counts only
where parts.py uses more of it than the parameters' values; and where there is no parts.py, because then the solids
follow from the model and its motion (mechanisms/automatic). A file whose bytes would be the same is not touched.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from mechanisms.stages.loading.inputs import Inputs, Recorder, observed, recording
from mechanisms.stages.loading.loading import author_code, has, load, package_of, params
from mechanisms.stages.loading.wishes import of_shot, scaling, wishing
from mechanisms.stages.parts import memory
from mechanisms.stages.parts.automatic_solids import needs_machine, needs_masses
from mechanisms.stages.parts.memory import KeptPieces, fields_of, only_annotates, plain_text, reported_cad_files, traced
from shared import contract
from shared.cluster.address import address
from shared.contract import Parts, Provenance, write_parts
from shared.contract.materials import MATERIALS
from shared.contract.parts import Kind
from shared.contract.quantity import counted, written
from shared.stage import console
from shared.stage.console import Shown, say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out, is_single_file, mechanism_file
from shared.stage.scale import Scale, scale_of
from shared.stage.stages import Stage, contract_sources, key_of, versions

_STAGES = ROOT / "mechanisms" / "stages"
_STAGE = ("stage", "bodies", "automatic_solids", "meshes", "memory")
SOURCES = [
    ROOT / "shared" / "shapes",
    _STAGES / "parts_files.py",
    *(_STAGES / "parts" / f"{name}.py" for name in _STAGE),
    *contract_sources(),
]
_MOTION = ("solving", "masses")
_AUTOMATIC = ("automatic", "loading/loading.py")
AUTOMATIC = [
    *SOURCES,
    *(_STAGES / name for name in _AUTOMATIC),
    *(_STAGES / "solve" / f"{name}.py" for name in _MOTION),
    _STAGES / "solve" / "space",
]
"""Sources of parts without a parts.py."""
MACHINE = "machine"
"""False in the notes of a model's parts that need nothing of the machine's."""
PACKAGES = ("cadquery", "cadquery-ocp", "numpy", "python-sat", "trimesh")


def run(name: str, scale: str = "", anyway: bool = False) -> None:
    """Make the parts of mechanism ``name``, or of its model at a scale, if their inputs have changed.

    Raises UserError naming the solid, the number and the remedy if a solid is refused; what was there stays. A refusal
    that took long is remembered until something changes, or they are to be made ``anyway``.
    """
    out = Out(name, scale_of(scale))
    before = set(sys.modules)
    with recording() as recorder:
        given = params(out.name)
    with_machine = _notes(out).get(MACHINE) is not False
    wish = _wish(out.name, scale_of(scale), with_machine)
    if _is_fresh(out, given, wish):
        say("parts", f"{out.title}: nothing to do")
        return
    if wish.scale is not None and wish.by_itself:
        with_machine = needs_machine(out.name)
        wish = _wish(out.name, wish.scale, with_machine)
    if not anyway:
        memory.refuse_again(out, lambda reads, inputs: _key(given, reads, inputs, wish))
    made = _of_cluster(out, given, wish, recorder) if address() else None
    made = made or _made_here(out, given, wish, before, recorder)
    count = _write(out, made.files, made.document)
    outputs = [out.parts, *(out.parts_folder / file for file in made.files)]
    notes = {"parameters": made.reads, "inputs": made.inputs.names(), **({} if with_machine else {MACHINE: False})}
    Stage(out, "parts", made.document.provenance.inputs, outputs).record(**notes)
    _kept_pieces(out).clear()
    memory.forget(out)
    say("parts", _summary(out.title, made.document, count))


class _Wish(NamedTuple):
    """Wishes of an author: what is left to the stage, and how the machine stands."""

    by_itself: bool
    """There is no parts.py."""
    mount: Kind | None
    """Mount that shot.py wishes."""
    scale: Scale | None = None
    """Scale of a model; None for the machine itself."""
    masses: str = ""
    """Masses of the machine, if the motion of its model follows from them."""


def _wish(name: str, scale: Scale | None = None, with_machine: bool = True) -> _Wish:
    """Return the wishes; ``with_machine`` if a model depends on the parts of its machine."""
    from mechanisms.stages.parts.automatic_solids import masses_of_machine

    by_itself = not has(name, "parts")
    masses = repr(masses_of_machine(name)) if by_itself and scale is not None and with_machine else ""
    return _Wish(by_itself, of_shot(name), scale, masses)


class _Result(NamedTuple):
    """All that the stage writes."""

    document: Parts
    files: Mapping[str, bytes]
    reads: list[str]
    inputs: Inputs


def _made_here(out: Out, given: Any, wish: _Wish, before: set[str], recorder: Recorder) -> _Result:
    """Run the author's code; ``recorder`` has seen what mechanism.py read. A refusal is remembered."""
    began, seen = time.monotonic(), _Seen()
    try:
        return _described(out, given, wish, before, recorder, seen)
    except UserError as error:
        seconds = time.monotonic() - began
        if memory.is_worth_it(error, seconds) and (wish.by_itself or seen.is_whole):
            reads, inputs = sorted(seen.reads), seen.inputs.joined(_of_mechanism(out.name, before, recorder))
            memory.remember(out, error, _key(given, reads, inputs, wish), reads, inputs)
        raise


@dataclass
class _Seen:
    """Parameters that parts.py was seen to read, and the files that it was made of and read."""

    reads: set[str] = field(default_factory=set)
    inputs: Inputs = field(default_factory=Inputs)
    is_whole: bool = False


def _of_mechanism(name: str, before: set[str], recorder: Recorder) -> Inputs:
    """Return the files that mechanism.py was made of and read."""
    from mechanisms.stages.loading.inputs import loaded_inputs

    return loaded_inputs(mechanism_file(name), package_of(name), before).joined(recorder.inputs())


def _kept_pieces(out: Out) -> KeptPieces:
    densities = {material: MATERIALS[material].density for material in sorted(MATERIALS)}
    return KeptPieces(out.folder / ".pieces", key_of(sources_hash(*SOURCES), versions(*PACKAGES), densities))


def _described(out: Out, given: Any, wish: _Wish, before: set[str], recorder: Recorder, seen: _Seen) -> _Result:
    from mechanisms.stages.parts.automatic_solids import follows_gravity, mount_of
    from mechanisms.stages.parts.bodies import Measured, described_body
    from shared.shapes.bodies import Bodies

    name = out.name
    with wishing(wish.mount), scaling(wish.scale):
        bodies = _build(name, given, seen)
    if isinstance(bodies, Bodies):
        bodies = bodies.on_stand()
    if wish.scale is not None:
        bodies = (bodies if isinstance(bodies, Bodies) else Bodies(bodies)).at_scale(wish.scale.ratio)
    for note in getattr(bodies, "notes", ()):
        say("parts", f"{name}: {note}")
    reads, inputs = sorted(seen.reads), seen.inputs
    if wish.by_itself or follows_gravity(bodies, wish.mount) or _more_than_values(name, given, reads):
        inputs = inputs.joined(_of_mechanism(name, before, recorder))
    key = _key(given, reads, inputs, wish)
    files: dict[str, bytes] = {}
    rods = getattr(bodies, "rods", {})
    measured = Measured(getattr(bodies, "along", False), getattr(bodies, "space", False))
    links = getattr(bodies, "links", {})
    shown, kept = Shown("parts", out.title, sum(map(len, bodies.values())), "solids written"), _kept_pieces(out)
    unsound: dict[str, UserError] | None = {} if wish.by_itself and wish.scale is None else None
    described = {
        body: described_body(
            name, body, solids, files, rods.get(body), measured, kept, shown.advance, unsound, links.get(body)
        )
        for body, solids in bodies.items()
    }
    for error in (unsound or {}).values():
        warn("parts", f"{error}; until then it is shown as a pane of glass")
    document = Parts(
        mechanism=name,
        provenance=Provenance(inputs=key, versions=versions(*PACKAGES)),
        mount=mount_of(name, bodies, wish.mount),
        schematic=getattr(bodies, "schematic", "") or _unsound(list(unsound or ())),
        bodies=described,
        without_solids=sorted(getattr(bodies, "left_out", ())),
        may_touch=sorted(getattr(bodies, "touching", ())),
        pieces_may_touch=sorted(getattr(bodies, "pieces_touching", ())),
    )
    return _Result(document, files, reads, inputs)


def _unsound(pieces: list[str]) -> str:
    """Return the sentence on pieces that are shown as panes; nothing without any."""
    from mechanisms.stages.automatic.glass import sentence_of

    if not pieces:
        return ""
    named = [piece.replace("_", " ") for piece in pieces]
    return sentence_of(named, "{} is not a closed solid" if len(named) == 1 else "{} are not closed solids")


def _of_cluster(out: Out, given: Any, wish: _Wish, recorder: Recorder) -> _Result | None:
    """Return the parts that a worker of the cluster made.

    None where they did not follow from what is here.
    """
    from mechanisms.stages.parts.on_cluster.dealt import made_elsewhere

    name, known = out.name, observed(_notes(out).get("inputs")) or Inputs()
    read = [name for kind in ("files", "modules") for name in known.joined(recorder.inputs()).names()[kind]]
    machine = Out(name).parts.read_bytes() if wish.masses and Out(name).parts.is_file() else b""
    made = made_elsewhere(name, wish.scale, machine, read)
    if made is None:
        return None
    document = msgspec.json.decode(made.document, type=Parts)
    reads, inputs = made.notes["parameters"], observed(made.notes["inputs"])
    if inputs is None or _key(given, reads, inputs, wish) != document.provenance.inputs:
        warn(
            "parts", f"{out.title}: its files read something that the worker has not, or has otherwise; it is made here"
        )
        return None
    return _Result(document, made.files, reads, inputs)


def are_current(name: str) -> bool:
    """Return True if the parts that are there are those of the mechanism as it is.

    Raises UserError for one without Params.
    """
    out = Out(name)
    return _is_fresh(out, params(out.name), _wish(out.name))


def run_if_needed(name: str, purpose: str) -> None:
    """Make the parts if what follows needs them.

    A ``motion`` needs them for masses that mechanism.py does not give. A ``model`` at a scale needs the machine's if
    its motion may follow from their masses; so does its ``proof``, which takes the motion that is solved with the parts
    that are there, and these must be current.
    """
    out = Out(name)
    if purpose == "motion":
        needed = needs_masses(out.name)
    elif purpose == "proof" and out.parts.is_file():
        needed = True
    else:
        needed = (purpose == "proof" or not has(out.name, "parts")) and needs_machine(out.name)
    if needed:
        run_or_none(name)


def are_outdated(name: str) -> bool:
    """Return True if the parts that are there were made of an older version of the mechanism."""
    out = Out(name)
    return out.parts.is_file() and bool(_notes(out)) and not are_current(name)


def run_or_none(name: str) -> None:
    """Run the stage for what needs no parts, as motion and plots.

    Where a mechanism without a parts.py has none, that is reported.
    """
    out = Out(name)
    try:
        run(name)
    except UserError as error:
        if has(out.name, "parts"):
            raise
        out.parts.unlink(missing_ok=True)  # of the model as it was
        warn("parts", f"{error}; until then there are none")


def _is_fresh(out: Out, given: Any, wish: _Wish) -> bool:
    notes = _notes(out)
    reads, inputs = notes.get("parameters"), observed(notes.get("inputs"))
    if not isinstance(reads, list) or not inputs:
        return False
    return Stage(out, "parts", _key(given, reads, inputs, wish), [out.parts]).is_fresh()


def _notes(out: Out) -> dict[str, Any]:
    """Return the notes of the last run of the stage."""
    return Stage(out, "parts", "", []).notes()


def _key(given: Any, reads: list[str], inputs: Inputs, wish: _Wish) -> str:
    """Return the hash of all that the parts follow from.

    ``reads`` are the attributes of Params that parts() reads.
    """
    fields = fields_of(given)
    values = {read: plain_text(fields[read]) for read in reads if read in fields}
    densities = {material: MATERIALS[material].density for material in sorted(MATERIALS)}
    sources = sources_hash(*(AUTOMATIC if wish.by_itself else SOURCES))
    return str(key_of(sources, wish, versions(*PACKAGES), densities, values, inputs.digest()))


def _more_than_values(name: str, given: Any, reads: list[str]) -> bool:
    """Return True if the parts follow from more of mechanism.py than from the values of parameters.

    A property or method of Params can compute anything, a value may have no text that shows it, and parts.py or what
    it imports may use other names of mechanism.py.
    """
    from mechanisms.stages.loading.inputs import author_files

    fields, package = fields_of(given), package_of(name)
    if is_single_file(name) or any(read not in fields or plain_text(fields[read]) is None for read in reads):
        return True
    return not only_annotates(
        author_files(mechanism_file(name, "parts"), package, mechanism_file(name)), f"{package}.mechanism"
    )


def _build(name: str, given: Any, seen: _Seen) -> dict[str, list[Any]]:
    """Return the solids by body; ``seen`` gets what parts.py reads, also where it fails."""
    from mechanisms.stages.loading.inputs import loaded_inputs
    from mechanisms.stages.parts.bodies import refuse_unfit

    if not has(name, "parts"):
        from mechanisms.stages.parts.automatic_solids import solids_of

        return solids_of(name)
    stand_in, seen.reads = traced(given)
    before, model = set(sys.modules), None if is_single_file(name) else mechanism_file(name)
    with recording() as recorder, reported_cad_files(recorder):
        module = load(name, "parts")
        try:
            with author_code(name):
                bodies = module.parts(stand_in)
        finally:
            loaded = loaded_inputs(mechanism_file(name, "parts"), package_of(name), before, leave_out=model)
            seen.inputs, seen.is_whole = loaded.joined(recorder.inputs()), True
    refuse_unfit(name, bodies)
    return bodies


def _write(out: Out, files: Mapping[str, bytes], document: Parts) -> int:
    """Write what differs from what is there, and remove what no solid makes any more.

    Returns the number of files written.

    parts.json is written last, so it never names a file that is not there.
    """
    count = 0
    for file, content in files.items():
        path = out.parts_folder / file
        if not path.is_file() or path.read_bytes() != content:
            write_bytes(path, content)
            count += 1
    write_parts(out.parts, document)
    for path in _leftovers(out.parts_folder, files):
        path.unlink()
    return count


def _leftovers(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    return [path for path in sorted(folder.iterdir()) if path.suffix in (".stl", ".step") and path.name not in files]


def _summary(name: str, document: Parts, count: int) -> str:
    pieces = [piece for body in document.bodies.values() for piece in body.pieces.values()]
    moving = sum(body.mass.mass for key, body in document.bodies.items() if key != "ground")
    triangles = sum(piece.triangles for piece in pieces)
    return (
        f"{name}: {counted(len(pieces), 'solid')} of {counted(len(document.bodies), 'body')}, {written(moving, 'kg')} "
        f"moving, {counted(triangles, 'triangle')}, {counted(count, 'file')} written"
    )


# The parts of a mechanism, for stages that take their masses and colours but go on without them.


def current_parts(out: Out, stage: str) -> Parts | None:
    """Return the parts that are there, unless they are outdated, which ``stage`` says."""

    if not out.parts.is_file():
        return None
    if are_current(out.name):
        return contract.read_parts(out.parts, out.name)
    remedy = to_run("parts", out.name)
    console.say(stage, f"{out.name}: the parts are of an older state, so their masses do not count; {remedy}")
    return None
