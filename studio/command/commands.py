"""Commands carried out by their stages: most run them in turn, some for several mechanisms."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from shared.stage.console import fail
from shared.stage.paths import all_mechanisms, imports_space, mechanism_file, variants_in
from shared.stage.scale import scale_of
from shared.system.missing import missing_libraries, sentence
from studio.command import stages
from studio.command.running import Run
from studio.command.stages import SCENES, Stage
from studio.command.table import Command


def do(command: Command, operand: str, said: Mapping[str, str], run: Run) -> int:
    """Run a command and return its exit code."""
    if any(stage.solids for stage in command.stages) and not run.planned and not _has_libraries():
        return 1
    return OTHERS.get(command.name, in_turn)(command, operand, said, run)


def in_turn(command: Command, operand: str, said: Mapping[str, str], run: Run) -> int:
    """Run the stages one after the other; the last replaces this process."""
    checked = command.of in ("machine", "")
    *before, last = (stage.words(operand, said, checked) for stage in command.stages)
    return run.all_of(before) or run.last(last)


def at_scale(command: Command, name: str, said: Mapping[str, str], run: Run) -> int:
    """Build parts, plates and clearance proof of a scaled model.

    The model moves as the mechanism does, whose parts are built first where the motion follows from their masses.
    Without a scale the stages are those of the mechanism. Raises UserError for a wrong scale before anything is built.
    """
    if scale_of(said.get("scale", "")) is None:
        return in_turn(command, name, said, run)
    plates = [stages.MODEL_PRINT] if command.name == "print" else []
    proof = [] if command.name == "parts" else [stages.SOLVE, stages.MODEL_CLEARANCE]
    first = stages.PARTS_FOR_PROOF if proof else stages.PARTS_FOR_MODEL
    chain = [first, stages.MODEL, *plates, *proof]
    *before, last = (stage.words(name, said, checked=True) for stage in chain)
    return run.all_of(before) or run.last(last)


def gallery(command: Command, _: str, said: Mapping[str, str], run: Run) -> int:
    """Render a poster of every mechanism and the page of them.

    A mechanism that fails is left out and makes the exit code 1.
    """
    bad = 0
    for name in all_mechanisms():
        chain = (*stages.MOTION, stages.CLEARANCE_OR_WARNING, stages.SHOT, stages.POSTER)
        code = run.all_of(stage.words(name, {**said, "aspect": "16:9"}) for stage in chain)
        if code >= 128:
            return code
        bad = bad or code
    return run.one(Stage("render", "gallery").words("", said)) or bad


def compare(command: Command, name: str, said: Mapping[str, str], run: Run) -> int:
    """Solve every variant, then draw all of them on the same pages."""
    names = run.output_of(Stage("mechanisms", "variants").words(name, said))
    if names is None:
        return 1
    for variant in names:
        code = run.all_of(stage.words(variant, said) for stage in stages.BARE_MOTION)
        if code != 0:
            return code
    return run.last(stages.COMPARE.words(name, said))


def article(command: Command, name: str, said: Mapping[str, str], run: Run) -> int:
    """Write the article; the variants that stand in it are solved first."""
    if imports_space(mechanism_file(name)):
        fail(f"{name} moves in space; articles are of mechanisms in the plane")
        return 1
    from render.article import VARIANTS

    for variant in variants_in(mechanism_file(name))[:VARIANTS] if "-" not in name else ():
        code = run.all_of(stage.words(f"{name}-{variant}", said) for stage in stages.BARE_MOTION)
        if code >= 128:
            return code  # one that does not run is left out
    return in_turn(command, name, said, run)


def film(command: Command, name: str, said: Mapping[str, str], run: Run) -> int:
    """Render the film; a comparison of two variants first prepares both."""
    if said.get("story") != "compare":
        return in_turn(command, name, said, run)
    names = run.output_of(Stage("mechanisms", "variants").words(name, said)) or []
    if not names:
        return 1
    for variant in (names[0], name if name in names[1:] else names[min(1, len(names) - 1)]):
        code = run.all_of(stage.words(variant, said) for stage in stages.SCENERY)
        if code != 0:
            return code
    return run.last(stages.FILM.words(name, said))


def export(command: Command, name: str, said: Mapping[str, str], run: Run) -> int:
    """Export the mechanism to a file of another program; a scene needs what pictures need."""
    if said.get("format") in SCENES:
        return do(replace(command, name="export a scene", stages=(*stages.SCENERY, stages.USD)), name, said, run)
    return in_turn(command, name, said, run)


def _has_libraries() -> bool:
    missing = missing_libraries()
    if missing:
        fail(f"parts and pictures need these libraries; nothing was built: {sentence(missing)}")
    return not missing


OTHERS: dict[str, Callable[[Command, str, Mapping[str, str], Run], int]] = {
    "gallery": gallery,
    "compare": compare,
    "article": article,
    "film": film,
    "export": export,
    "parts": at_scale,
    "print": at_scale,
    "clearance": at_scale,
}
"""Commands that are more than their stages in turn."""
