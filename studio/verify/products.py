"""Plates, outlines and files for other programs, rebuilt in scratch and compared byte by byte."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from shared.contract.quantity import counted
from shared.stage.errors import UserError
from shared.stage.paths import Out
from shared.stage.stages import Stage, outdated_by
from studio.verify import files
from studio.verify.files import Finding

Again = Callable[..., None]
"""Runs a stage with its results in scratch: module, stage, name, options."""


def of_print(out: Out, scratch: Path, again: Again) -> list[Finding]:
    """Return one finding of plates, outlines and lists, of the first file that differs.

    There is none if nothing was laid out.

    ``scratch`` is the mechanism's folder there, which has its parts.
    """
    if not out.print_folder.is_dir():
        return []
    what, notes = "print (3MF, STL, DXF, lists)", Stage(out, "print", "", []).notes()
    if "bed" not in notes:
        return [Finding(what, "missing", "no record says for which bed they are; lay them out again")]
    if changed := outdated_by(out, out.print_folder / "pieces.md"):
        return [Finding(what, "outdated", f"{' and '.join(changed)} changed since")]
    parts = files.compare("parts.json", out.parts, scratch / "parts" / "parts.json")
    if parts.verdict == "outdated":  # of other inputs, so the plates are as well
        return [Finding(what, parts.verdict, parts.detail)]
    again("mechanisms", "print", out.name, f"--bed={notes['bed']}", f"--gap={notes['gap']}")
    here, there = out.print_folder, scratch / "print"
    names = sorted({path.name for folder in (here, there) for path in folder.iterdir() if path.is_file()})
    findings = [files.compare(name, here / name, there / name) for name in names if not name.startswith(".")]
    wrong = [finding for finding in findings if finding.verdict != "same"]
    if wrong:
        said = f"{len(wrong)} of {counted(len(findings), 'file')}, such as {wrong[0].what} {wrong[0].detail}"
        return [Finding(what, "differs", said)]
    return [Finding(what, "same", counted(len(findings), "file"))]


def of_exports(out: Out, scratch: Path, again: Again) -> list[Finding]:
    """Return a finding of each exported file. ``scratch`` is as in :func:`of_print`."""
    return [_of_export(out, form, file, is_fresh, scratch, again) for form, file, is_fresh in _exported(out)]


def _exported(out: Out) -> Iterator[tuple[str, Path, Callable[[str, str], bool]]]:
    """Yield the formats of exported files, each with a check that it is of the current mechanism."""
    from mechanisms.stages.export import stage as export
    from render import usd

    for form in export.FORMATS:
        if (file := export.file_of(out, form)).is_file():
            yield form, file, export.is_fresh
    for form, suffix in usd.FORMATS.items():
        if (file := out.folder / "export" / f"{out.name}{suffix}").is_file():
            yield form, file, usd.is_fresh


def _of_export(
    out: Out, form: str, file: Path, is_fresh: Callable[[str, str], bool], scratch: Path, again: Again
) -> Finding:
    what, notes = f"export ({file.name})", Stage(out, f"export-{form}", "", [])
    if not notes.stamp.is_file():
        return Finding(what, "missing", "no record says what it was made of; export it again")
    try:
        if not is_fresh(out.name, form) and outdated_by(out, file) != [file.name]:
            return Finding(what, "outdated", "something that it follows from has changed since")
        if "time" in notes.notes():
            again("mechanisms", "export", out.name, f"--format={form}", f"--time={notes.notes()['time']!r}")
        else:
            again("render", "usd", out.name, f"--format={form}")
    except UserError as error:
        return Finding(what, "differs", f"it cannot be rebuilt: {error}")
    return files.compare(what, file, scratch / "export" / file.name)
