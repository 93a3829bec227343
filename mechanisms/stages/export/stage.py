"""The stage ``export``: the solved mechanism in the file of another program, out/<name>/export/."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mechanisms.stages.export import assembly, drawings, mjcf, urdf
from mechanisms.stages.export.assembly import Wanted
from mechanisms.stages.export.modelica.text import modelica
from mechanisms.stages.loading import loading
from mechanisms.stages.loading.inputs import Inputs, observed
from mechanisms.stages.solve import stage as solving
from shared import contract
from shared.stage.console import say, warn
from shared.stage.errors import UserError, did_you_mean
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out, known_name
from shared.stage.stages import Stage, key_of

SOURCES = [ROOT / "mechanisms" / "stages" / name for name in ("export", "dxf_file.py")]
Written = tuple[bytes, list[str]]
"""A file, and what it leaves out."""


def run(name: str, form: str, time: float = 0.0) -> None:
    """Solve the mechanism and write it as ``form``; ``time`` (s) is that of a pose. Raises UserError."""
    name = known_name(name)
    if form not in FORMATS:
        raise UserError(
            f"there is no format {form!r} to export; choose one of: {', '.join(FORMATS)}{did_you_mean(form, FORMATS)}"
        )
    out = Out(name)
    parts = solving.parts_of(out)

    def written() -> Written:
        solution, _ = solving.solve(name, parts)
        if form in POSED:
            _warn_of_time(name, time, float(solution.t[0]), float(solution.t[-1]))
        with loading.author_code(name):
            return FORMATS[form][1](Wanted(solution, time, out, parts))

    (content, left_out), inputs = loading.recorded(name, written)
    file = file_of(out, form)
    write_bytes(file, content)
    Stage(out, f"export-{form}", _key(parts, inputs, form, time), [file]).record(inputs=inputs.names(), time=time)
    for words in left_out:
        warn("export", f"{name}: left out: {words}")
    say("export", f"{name}: {file}: {len(content) / 1000:.0f} kB")


def is_fresh(name: str, form: str) -> bool:
    """Return True if the file that is there is of the mechanism as it is."""
    out = Out(name)
    notes = Stage(out, f"export-{form}", "", []).notes()
    inputs, time = observed(notes.get("inputs")), notes.get("time", 0.0)
    file = file_of(out, form)
    if not inputs:
        return False
    return Stage(out, f"export-{form}", _key(solving.parts_of(out), inputs, form, time), [file]).is_fresh()


def file_of(out: Out, form: str) -> Path:
    """Return where the file of a format is."""
    return out.folder / "export" / f"{out.name}{FORMATS[form][0]}"


def _key(parts: contract.Parts | None, inputs: Inputs, form: str, time: float) -> str:
    """Return the hash of all that a file follows from.

    That of the solids takes them whole, others take their masses alone.
    """
    solids = parts.provenance.inputs if parts is not None and form == "step" else ""
    return str(key_of(solving.motion_key(parts, inputs), solids, form, time, sources_hash(*SOURCES)))


def _warn_of_time(name: str, time: float, first: float, last: float) -> None:
    if time and not first <= time <= last:
        nearest = first if time < first else last
        warn("export", f"{name}: the motion is from {first:g} to {last:g} s; the pose is that of {nearest:g} s")


def _csv(wanted: Wanted) -> Written:
    from mbsd.base.files import frame_csv

    return frame_csv(wanted.solution.to_frame()).encode(), []


def _parquet(wanted: Wanted) -> Written:
    content = io.BytesIO()
    wanted.solution.to_frame().reset_index().to_parquet(content, index=False)
    return content.getvalue(), []


def _text(write: Callable[..., Any], timed: bool = False) -> Callable[[Wanted], Written]:
    def written(wanted: Wanted) -> Written:
        made = write(wanted.solution, wanted.time) if timed else write(wanted.solution)
        text, left_out = made if isinstance(made, tuple) else (made, [])
        return text.encode(), left_out

    return written


def _fmu(wanted: Wanted) -> Written:
    from mechanisms.stages.export.fmu import fmu

    return fmu(wanted.solution)


FORMATS: dict[str, tuple[str, Callable[[Wanted], Written]]] = {
    "csv": (".csv", _csv),
    "parquet": (".parquet", _parquet),
    "svg": (".svg", _text(drawings.svg, timed=True)),
    "dxf": (".dxf", _text(drawings.dxf, timed=True)),
    "step": (".step", assembly.step),
    "mjcf": (".xml", _text(mjcf.mjcf)),
    "urdf": (".urdf", _text(urdf.urdf)),
    "fmu": (".fmu", _fmu),
    "modelica": (".mo", _text(modelica)),
}
"""Formats by name: the ending of the file, and its writer."""
POSED = ("svg", "dxf", "step")
"""Formats of one pose."""
