"""Stages of a command, run one after the other as processes, listed as a plan, or summarised as JSON."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from render.presets import preset_named
from shared.stage.memory import remembered
from shared.stage.paths import ROOT, Out, out_root
from shared.stage.scale import scale_of
from shared.stage.signals import VARIABLE, Stopped, terminable
from shared.stage.stages import outdated_by, results_of
from studio.command.table import COMMANDS, Command

# Lines of ``--plan``: each stage as the command that runs it alone, and what it writes.


COMMAND_OF = {
    "plots": "plot",
    "imports": "import",
    "usd": "export",
    "pages": "view-all",
    "run": "all",
    "start": "overnight",
}
"""Commands that run a stage of another name."""
EVERYTHING = COMMANDS["run"].help.replace("one", "every", 1)
MADE = {
    **{name: command.help for name, command in COMMANDS.items()},
    "all": f"{EVERYTHING}; goes on after a failure",
    "overnight": f"{EVERYTHING}; in the background, also after the logout",
    "shot": "the description of the film, checked: out/<name>/shot.json",
    "designs": "motions with other numbers, for numbers to drag without Python: out/<name>/designs.bin",
    "usd": "the scene as OpenUSD: out/<name>/export/",
}
"""Result of a stage or command, in words."""
CONDITIONS = {
    "--if-needed=motion": "only if mechanism.py leaves a mass to them",
    "--if-needed=model": "of full size, only if the motion needs their masses",
    "--if-needed=proof": "of full size, only if the motion needs their masses",
    "--or-none": "if there can be any",
    "--or-warn": "for parts that can be built",
}
"""Conditions under which a stage makes something, by the word that asks for it."""


def plan_line(words: Sequence[str]) -> str:
    """Return one line on a stage: its command as a user types it, and its result, with file and condition.

    ``words`` is the command line of the stage, ``python -m ROOM NAME ...``.
    """
    room, *rest = words[2:]
    if room not in ("mechanisms", "render", "studio.night", "shared.cluster"):
        rest = [room.rpartition(".")[2], *rest]
    stage, *rest = rest
    shown = [word for word in rest if word != "--" and word not in CONDITIONS and not word.startswith("--python=")]
    operands = [word for word in shown if not word.startswith("-")]
    options = [_typed(word) for word in shown if word.startswith("-")]
    command = COMMAND_OF.get(stage, stage)
    text = _named(MADE["usd" if stage == "usd" else command], operands[0] if operands else "<name>", shown)
    conditions = [CONDITIONS[word] for word in rest if word in CONDITIONS]
    return f"{' '.join([command, *operands, *options]):<34}  {', '.join([text, *conditions])}".rstrip()


def _typed(word: str) -> str:
    """Return an option as a user types it: ``--over 'a=1; b=2'`` for ``--over=a=1; b=2``."""
    option, has_value, value = word.partition("=")
    return f"{option} {shlex.quote(value)}" if has_value else option


def _named(text: str, name: str, words: Sequence[str]) -> str:
    """Return the text with the names of this mechanism, preset, scale and folder of results."""
    said = dict(word.removeprefix("--").split("=", 1) for word in words if word.startswith("--") and "=" in word)
    scale = scale_of(said.get("scale", ""))
    preset = preset_named(said["preset"], said.get("aspect", "")).name if "preset" in said else "<preset>"
    text = text.replace("<name>/", f"<name>/{scale.slug}/") if scale else text
    text = text.replace("<name>", name).replace("<preset>", preset)
    return text.replace("out/", f"{out_root()}/") if "MBSD_OUT" in os.environ else text


# Stages of a command, run one after the other as processes; the first that fails ends it.


GRACE = 20.0
"""Seconds that a stage has to clean up when the command is stopped."""


@dataclass
class Outcome:
    """One stage that ran."""

    stage: str
    code: int
    seconds: float


@dataclass
class Run:
    """Stages of a command; ``quiet`` sends their output to stderr, ``planned`` only lists them."""

    environment: Mapping[str, str]
    quiet: bool = False
    planned: bool = False
    done: list[Outcome] = field(default_factory=list)

    def all_of(self, commands: Iterable[Sequence[str]]) -> int:
        """Run the stages; return the exit code of the first that fails, else 0."""
        for words in commands:
            code = self.one(words)
            if code != 0:
                return code
        return 0

    def one(self, words: Sequence[str]) -> int:
        """Run one stage to its end and return its exit code.

        A stop is passed on, and ends the command when the stage has ended.
        """
        if self.planned:
            print(plan_line(words), flush=True)
            return 0
        began = time.monotonic()
        sys.stdout.flush()
        process = subprocess.Popen(
            list(words), cwd=ROOT, env=self._environment(), stdout=sys.stderr if self.quiet else None
        )
        try:
            with terminable():
                code = process.wait()
        except (Stopped, KeyboardInterrupt):
            _end(process)
            raise
        code = 128 - code if code < 0 else code
        self.done.append(Outcome(" ".join(words[3:4]) or words[2], code, round(time.monotonic() - began, 3)))
        return code

    def output_of(self, words: Sequence[str]) -> list[str] | None:
        """Return the lines that a stage prints; None if it fails, which it has reported."""
        done = subprocess.run(list(words), cwd=ROOT, env=self._environment(), stdout=subprocess.PIPE, text=True)
        return done.stdout.splitlines() if done.returncode == 0 else None

    def last(self, words: Sequence[str]) -> int:
        """Run one stage in place of this process, so that keys and signals reach it."""
        if self.planned or self.quiet or os.name != "posix":
            return self.one(words)
        os.chdir(ROOT)
        sys.stdout.flush()
        return os.execve(words[0], list(words), self._environment())

    def _environment(self) -> dict[str, str]:
        own = {VARIABLE: os.environ.get(VARIABLE) or str(os.getpid())}
        paths = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH", ""))))
        return {**os.environ, **self.environment, **own, "PYTHONPATH": paths}


def _end(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(GRACE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


# Summary of a command as JSON for other programs.


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
