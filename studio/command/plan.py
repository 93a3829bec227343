"""Lines of ``--plan``: each stage as the command that runs it alone, and what it writes."""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence

from render.presets import preset_named
from shared.stage.paths import out_root
from shared.stage.scale import scale_of
from studio.command.table import COMMANDS

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
    "usd": "the scene as OpenUSD: out/<name>/export/",
}
"""Result of a stage or command, in words."""
CONDITIONS = {
    "--if-needed=motion": "only if mechanism.py leaves a mass to them",
    "--if-needed=model": "of full size, only if the motion needs their masses",
    "--if-needed=proof": "of full size, only if the motion needs their masses",
    "--or-none": "if there can be any",
}
"""When a stage makes something, by the word that asks for it."""


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
