"""The stage animate: the skeleton in motion, from mechanism.py alone: animation.mp4 and animation.gif."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from mechanisms.stages.loading import loading
from mechanisms.stages.loading.inputs import Inputs, observed, sources_state
from mechanisms.stages.parts.stage import current_parts
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.skeleton_file import body_colours, main_material
from shared.contract import Parts
from shared.stage import console
from shared.stage.errors import UserError, did_you_mean
from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, Out
from shared.stage.stages import Stage, key_of, versions

if TYPE_CHECKING:
    from mbsd import Solution


QUANTITIES = ("velocities", "accelerations", "forces", "reactions", "energy")
USUAL = "reactions"
"""Quantity of a film without a view."""
VIEWS = (*QUANTITIES, "skeleton", "each", "all")
"""Quantities; the mechanism alone; a film of each quantity; all of them side by side in one."""
PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "matplotlib", "pillow", "imageio-ffmpeg")
SUFFIXES = (".mp4", ".gif")
_STAGE = ("animate", "loading/loading", *(f"solve/{name}" for name in ("solving", "masses", "skeleton_file")))
SOURCES = [ROOT / "mechanisms" / "stages" / f"{name}.py" for name in _STAGE]


def run(name: str, view: str = "") -> None:
    """Draw the films of one view unless they already stand for the same inputs. Raises UserError."""
    out = Out(name)
    films = films_of(view)
    parts = current_parts(out, "animate")
    stale = [words for words in films if not _fresh(out, parts, words)]
    if not stale:
        console.say("animate", f"{name}: nothing to do")
        return
    solution, inputs = loading.recorded(name, lambda: solve(name, parts))
    for words in stale:
        paths = _paths(out, words)
        for path in paths:
            _draw(solution, path, words, parts)
        Stage(out, paths[0].stem, _key(parts, inputs), paths).record(inputs=inputs.names())


def films_of(view: str) -> list[str]:
    """Return the views of the films to make: ``""`` is one large mechanism with its reactions.

    Raises UserError for unknown words.
    """
    words = [word.strip() for word in view.split(",") if word.strip()]
    for word in words:
        if word not in VIEWS:
            raise UserError(
                f"VIEW={view!r}: there is no view {word!r}; there is: {', '.join(VIEWS)}; commas join several, and "
                f"without VIEW one mechanism has its {USUAL}{did_you_mean(word, VIEWS)}"
            )
    if {"each", "skeleton", "all"} & {*words}:
        if len(words) > 1:
            raise UserError(f"VIEW={view!r}: 'each', 'skeleton' and 'all' stand alone")
        return list(QUANTITIES) if words == ["each"] else words
    return [",".join(word for word in QUANTITIES if word in words)]


def solve(name: str, parts: Parts | None) -> Solution:
    """Return the motion; says which masses are those of the parts, and which are estimated.

    Raises UserError.
    """
    from mechanisms.stages.solve.masses import give_masses_aloud

    m, module, p = solving.model_of(name)
    give_masses_aloud("animate", name, m, parts)
    return solving.motion_of(name, module, m, p)


def _paths(out: Out, words: str) -> list[Path]:
    return [out.animation(words.replace(",", "-"), suffix) for suffix in SUFFIXES]


def _fresh(out: Out, parts: Parts | None, words: str) -> bool:
    paths = _paths(out, words)
    known = observed(Stage(out, paths[0].stem, "", []).notes().get("inputs"))
    return bool(known) and Stage(out, paths[0].stem, _key(parts, known), paths).is_fresh()


def _key(parts: Parts | None, inputs: Inputs) -> str:
    """Return the hash of all that a film follows from.

    ``inputs``: what mechanism.py is made of, and what it reads.
    """
    masses = parts and {body: (solids.mass, main_material(solids)) for body, solids in parts.bodies.items()}
    sources = sources_hash(*SOURCES), sources_state("mbsd"), sources_state("mbsd/drawing")
    return key_of(*sources, masses, versions(*PACKAGES), inputs.digest())


def _draw(solution: Solution, path: Path, words: str, parts: Parts | None) -> None:
    from mbsd import MechanismError
    from mbsd.drawing.animation.animate import animate

    name = solution.mechanism.name
    show = "all" if words == "all" else () if words == "skeleton" else tuple((words or USUAL).split(","))
    with ExitStack() as stack:
        bar: console.Progress | None = None

        def progress(done: int, total: int) -> None:
            nonlocal bar
            if bar is None:
                bar = stack.enter_context(console.progress("animate", total, "picture"))
            bar.advance()

        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            inks = body_colours(solution.mechanism, parts)
            film = animate(solution, path, show, progress=progress, inks=inks)
        except MechanismError as error:
            raise UserError(f"{name}: {path.name}: {error}") from error
    rate = "" if film.rate == 1.0 else f", {film.rate:g} of real time"
    size = path.stat().st_size / 1e6
    console.say("animate", f"{name}: {path}: {film.pictures} pictures, {film.seconds:.1f} s{rate}, {size:.1f} MB")
