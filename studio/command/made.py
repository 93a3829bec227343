"""Summary of a command as JSON for other programs."""

from __future__ import annotations

from pathlib import Path

import msgspec

from shared.stage.memory import remembered
from shared.stage.paths import Out
from shared.stage.stages import outdated_by, results_of
from studio.command.running import Run
from studio.command.table import Command


def summary(command: Command, machine: str, run: Run, code: int) -> str:
    """Return one line of JSON on a command that has ended.

    It has the exit code, the stages with their seconds, the files that exist now, and those of them that are older than
    the results that they were made of.
    """
    out = Out(machine)
    paths = sorted(path for path in out.folder.rglob("*") if _counts(path, out))
    films = sorted(out.film("*").parent.glob(f"{out.name}-*.mp4"))
    with remembered():
        older = [path for path in (*paths, *films) if results_of(out, path) and outdated_by(out, path)]
    return msgspec.json.encode(
        {
            "command": command.name,
            "machine": machine,
            "ok": code == 0,
            "exit_code": code,
            "stages": [{"stage": done.stage, "ok": done.code == 0, "seconds": done.seconds} for done in run.done],
            "folder": out.folder.as_posix(),
            "files": [path.relative_to(out.folder).as_posix() for path in paths],
            "films": [film.as_posix() for film in films],
            "older": [path.relative_to(out.folder).as_posix() if path in paths else path.as_posix() for path in older],
        }
    ).decode()


def _counts(path: Path, out: Out) -> bool:
    inside = path.relative_to(out.folder).parts
    return path.is_file() and not any(part.startswith(".") for part in inside) and inside[0] != "frames"
