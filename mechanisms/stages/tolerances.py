"""The stage tolerances: how far results stray as parts do, by tolerances.py of a mechanism."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mechanisms.stages.loading import loading
from mechanisms.stages.loading.inputs import Inputs, observed, sources_state
from mechanisms.stages.loading.loading import refuse_arguments
from mechanisms.stages.parts.stage import current_parts
from mechanisms.stages.solve import solving
from shared.contract import Parts
from shared.stage import console
from shared.stage.errors import UserError, did_you_mean
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import NAME, ROOT, Out, is_single_file, known_name, shown_file
from shared.stage.stages import Stage, key_of, versions

if TYPE_CHECKING:
    from mbsd import Mechanism, Tolerances


# Requests of tolerances.py: by the name of a result, the arguments of :func:`mbsd.tolerances`.
#
#     def tolerances(p: Params) -> dict[str, dict[str, Any]]:
#         sizes = {"crank": "m", "rod": "m", "A": Clearance.from_fit(0.006, "H7/g6")}
#         return {"far_end": {"sizes": sizes, "result": largest("slider.x"), "limits": (0.1597, 0.1603)}}
#
# A mechanism.py with a DURATION gives its own where nothing else is said.

TAKEN = ("sizes", "result", "limits", "n", "seed", "duration", "steps", "way", "sobol", "corners", "confidence")
"""Arguments of mbsd.tolerances that a result may give."""
FORM = 'def tolerances(p): return {"far_end": {"sizes": {"crank": 5e-5}, "result": largest("slider.x")}}'


def wished_results(name: str, m: Mechanism, p: Any) -> dict[str, Callable[..., Tolerances]]:
    """Return by result a function that finds it.

    Raises UserError for an invalid request, before it computes.
    """
    module = loading.load(name, "tolerances")
    file = shown_file(name, "tolerances")
    refuse_arguments(file, module.tolerances, p)
    with loading.author_code(name):
        given = module.tolerances(p)
    if not isinstance(given, Mapping) or not given:
        raise UserError(f"{file}: tolerances() returned {_shown(given)}; it names results: {FORM}")
    duration = loading.constant(name, loading.load(name, "mechanism"), "DURATION")
    usual = {} if duration is None else {"duration": duration}
    for result, options in given.items():
        _refuse_unfit(file, result, options)
    return {result: _ready(name, file, result, m, usual | dict(options)) for result, options in given.items()}


def _refuse_unfit(file: str, result: Any, options: Any) -> None:
    if not isinstance(result, str) or not NAME.fullmatch(result):
        raise UserError(
            f"{file}: {result!r} is no name of a result, which is that of its files, too; write lower-case letters, "
            "digits and underscores, a letter first"
        )
    if not isinstance(options, Mapping):
        raise UserError(f"{file}: '{result}' is {_shown(options)}; it takes a dict: {FORM}")
    for word in options:
        if word not in TAKEN:
            raise UserError(
                f"{file}: '{result}' takes no {word!r}; it takes: {', '.join(TAKEN)}{did_you_mean(str(word), TAKEN)}"
            )
    for word in ("sizes", "result"):
        if word not in options:
            raise UserError(f"{file}: '{result}' says no '{word}'; {FORM}")


def _ready(name: str, file: str, result: str, m: Mechanism, options: dict[str, Any]) -> Callable[..., Tolerances]:
    from mbsd import MechanismError
    from mbsd.tolerancing.tolerances import request_of as ready

    try:
        with loading.author_code(name), solving.model_warnings_said():
            return ready(copy.deepcopy(m), **options, progress=_progress(f"{name}: {result}"))
    except MechanismError as error:
        raise UserError(f"{file}: '{result}': {error}") from error


def _progress(what: str) -> Callable[[float], None]:
    """Says now and then what part of the machines is solved, where that takes long."""
    bar: list[console.Shown] = []

    def progress(part: float) -> None:
        if not bar:
            bar.append(console.Shown("tolerances", what, 100, "per cent of its machines"))
        bar[0].count = max(1, int(100 * part)) - 1
        bar[0].advance()

    return progress


def _shown(given: Any) -> str:
    from mbsd.base.names import shown

    return shown(given)


# Results for people: a sentence for each in the terminal, and summary.md.

NOTHING = 0.01
"""Part of the standard deviation, and of the yield, that is not worth a tighter tolerance."""


def sentence(result: str, t: Tolerances) -> str:
    """Return the sentence on how far a result strays, how many are good, and which dimension to tighten."""
    return f"{result}: {_spread(t)}; {advice(t)}"


def _spread(t: Tolerances) -> str:
    within = "" if t.yields is None else f", {t.yields.part:.2%} within limits"
    failed = f", {len(t.failed)} of {len(t)} machines fail" if len(t.failed) else ""
    return f"{t.mean:.6g} +- {3 * t.std:.3g} (three standard deviations){within}{failed}"


def advice(t: Tolerances) -> str:
    """Return the sentence that says which dimension to tighten first, and what that gains."""
    best = t.tighten[0]
    gain = 1.0 - best.std_halved / t.std if t.std > 0.0 else 0.0
    more = 0.0 if t.yields is None else best.yield_halved - t.yields.part
    if t.yields is not None and t.yields.part == 1.0:
        return "all are good, so nothing is to be tightened"
    if max(gain, more) < NOTHING:
        return "no dimension alone makes a difference if its tolerance is halved"
    of_yield = "" if t.yields is None else f" and {best.yield_halved:.2%} are within limits"
    return f"tighten '{best.name}' first: with half its tolerance it strays {gain:.0%} less{of_yield}"


def page(name: str, results: Mapping[str, Tolerances]) -> str:
    """summary.md: a section a result."""
    parts = [f"# Tolerances of {name}\n"]
    for result, t in results.items():
        advised = advice(t)
        parts += [f"## {result}\n", f"{advised[0].upper()}{advised[1:]}.\n", f"![{result}]({result}.svg)\n"]
        parts += [f"```text\n{t}\n```\n"]
    return "\n".join(parts)


# The stage ``tolerances``: what tolerances.py asks, found of thousands of machines: out/<name>/tolerances/.
#
# A result has a table, a row a dimension, what brings most first (.csv), and a plot (.svg); summary.md has what is to
# be tightened. Masses, which say to which side pins with play lie, are those of mechanism.py, else of the parts where
# these are there and current, else estimates.

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "matplotlib")
SOURCES = [ROOT / "mechanisms" / "stages" / name for name in ("tolerances.py", "loading", "solve")]
SUFFIXES = (".csv", ".svg")


def run(name: str) -> None:
    """Find and write what tolerances.py asks, unless it is there of the same inputs. Raises UserError."""
    name = known_name(name)
    out = Out(name)
    if not loading.has(name, "tolerances"):
        where = "says nothing of tolerances" if is_single_file(name) else "is missing"
        raise UserError(f"{name}: {shown_file(name, 'tolerances')} {where}; write {FORM}")
    parts = current_parts(out, "tolerances")
    before = _stage(out).notes()
    known = observed(before.get("inputs"))
    files = [_folder(out) / file for file in before.get("files", [])]
    if known and files and Stage(out, "tolerances", _key(parts, known), files).is_fresh():
        console.say("tolerances", f"{name}: nothing to do: {_folder(out) / 'summary.md'}")
        return
    results, inputs = _computed(name, parts)
    written = _write(out, results)
    for file in set(files) - set(written):
        file.unlink(missing_ok=True)
    notes = {"inputs": inputs.names(), "files": [file.name for file in written]}
    Stage(out, "tolerances", _key(parts, inputs), written).record(**notes)
    for result, t in results.items():
        console.say("tolerances", f"{name}: {sentence(result, t)}")
    console.say("tolerances", f"{name}: {_folder(out) / 'summary.md'}, and a table and a plot of each result")


def _folder(out: Out) -> Path:
    return out.folder / "tolerances"


def _stage(out: Out) -> Stage:
    return Stage(out, "tolerances", "", [])


def _key(parts: Parts | None, inputs: Inputs) -> str:
    """Return the hash of all that follows.

    ``inputs``: what the author's files are made of, and what they read.
    """
    masses = parts and {body: solids.mass for body, solids in parts.bodies.items()}
    sources = sources_hash(*SOURCES), sources_state("mbsd"), sources_state("mbsd/drawing")
    return key_of(*sources, masses, versions(*PACKAGES), inputs.digest())


def _computed(name: str, parts: Parts | None) -> tuple[dict[str, Tolerances], Inputs]:
    """Return all results, after all were checked, and what they were made of."""
    from mbsd import MechanismError

    def compute() -> dict[str, Tolerances]:
        results: dict[str, Tolerances] = {}
        for result, find in wished_results(name, _built(name, parts), loading.params(name)).items():
            try:
                with loading.author_code(name), solving.model_warnings_said():
                    results[result] = find()
            except MechanismError as error:
                raise UserError(f"{shown_file(name, 'tolerances')}: '{result}': {error}") from error
        return results

    return loading.recorded(name, compute, ("tolerances", "mechanism"))


def _built(name: str, parts: Parts | None) -> Mechanism:
    from mechanisms.stages.solve.masses import give_masses_aloud

    m, _, _ = solving.model_of(name)
    give_masses_aloud("tolerances", name, m, parts)
    return m


def _write(out: Out, results: Mapping[str, Tolerances]) -> list[Path]:
    from mbsd import MechanismError

    folder = _folder(out)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for result, t in results.items():
        table, plot = (folder / f"{result}{suffix}" for suffix in SUFFIXES)
        try:
            t.to_csv(table)
            picture = t.plot()
            picture.ax.set_xlabel(result.replace("_", " "))
            picture.save(plot)
        except MechanismError as error:  # the disk is full
            raise UserError(f"{out.name}: {error}") from error
        written += [table, plot]
    write_bytes(folder / "summary.md", page(out.name, results).encode())
    return [*written, folder / "summary.md"]
