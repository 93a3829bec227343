"""The stage ``tolerances``: what tolerances.py asks, found of thousands of machines: out/<name>/tolerances/.

A result has a table, a row a dimension, what brings most first (.csv), and a plot (.svg); summary.md has what is to be
tightened. Masses, which say to which side pins with play lie, are those of mechanism.py, else of the parts where these
are there and current, else estimates.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from mechanisms.stages.loading import loading
from mechanisms.stages.loading.inputs import Inputs, observed, sources_state
from mechanisms.stages.loading.recording import recording
from mechanisms.stages.parts.current import current_parts
from mechanisms.stages.solve import solving
from mechanisms.stages.tolerances.asked import FORM, asked
from mechanisms.stages.tolerances.summary import page, sentence
from shared.stage import console
from shared.stage.errors import UserError
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out, is_single_file, known_name, mechanism_file, shown_file
from shared.stage.stages import Stage, key_of, versions

if TYPE_CHECKING:
    from mbsd import Mechanism, Tolerances
    from shared.contract import Parts

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "matplotlib")
SOURCES = [ROOT / "mechanisms" / "stages" / folder for folder in ("tolerances", "loading", "solve")]
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
    results, inputs = _found(name, parts)
    written = _write(out, results)
    for file in set(files) - set(written):
        file.unlink(missing_ok=True)
    notes = {"inputs": inputs.names(), "files": [file.name for file in written]}
    Stage(out, "tolerances", _key(parts, inputs), written).done(**notes)
    for result, t in results.items():
        console.say("tolerances", f"{name}: {sentence(result, t)}")
    console.say("tolerances", f"{name}: {_folder(out) / 'summary.md'}, and a table and a plot of each result")


def _folder(out: Out) -> Path:
    return out.folder / "tolerances"


def _stage(out: Out) -> Stage:
    return Stage(out, "tolerances", "", [])


def _key(parts: Parts | None, inputs: Inputs) -> str:
    """Hash of all that follows; ``inputs``: what the author's files are made of, and what they read."""
    masses = parts and {body: solids.mass for body, solids in parts.bodies.items()}
    sources = sources_hash(*SOURCES), sources_state("mbsd"), sources_state("mbsd/drawing")
    return key_of(*sources, masses, versions(*PACKAGES), inputs.digest())


def _found(name: str, parts: Parts | None) -> tuple[dict[str, Tolerances], Inputs]:
    """All results, after all were looked at, and what they were made of."""
    from mbsd import MechanismError
    from mechanisms.stages.loading.loaded_files import loaded_inputs

    before = set(sys.modules)
    results: dict[str, Tolerances] = {}
    with recording() as recorder:
        m, p = _built(name, parts), loading.params(name)
        for result, find in asked(name, m, p).items():
            try:
                with loading.author_code(name), solving.model_warnings_said():
                    results[result] = find()
            except MechanismError as error:
                raise UserError(f"{shown_file(name, 'tolerances')}: '{result}': {error}") from error
    inputs = recorder.inputs()
    for file in ("tolerances", "mechanism"):
        loaded = loaded_inputs(mechanism_file(name, file), loading.package_of(name), before)
        loaded.sources.pop("mbsd", None)  # it counts anyway
        inputs = loaded.joined(inputs)
    return results, inputs


def _built(name: str, parts: Parts | None) -> Mechanism:
    from mechanisms.stages.solve.masses import give_masses_aloud

    m = solving.build(name, loading.load(name, "mechanism"), loading.params(name))
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
