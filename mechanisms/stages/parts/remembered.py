"""A refusal that took long to find, remembered by the content that it follows from: it is not looked for again."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mechanisms.stages.loading.inputs import Inputs, observed
from shared.stage.errors import BUSY, UserError
from shared.stage.face import said, to_run
from shared.stage.paths import Out
from shared.stage.stages import Stage

LONG = 5.0
"""Seconds; what is refused sooner is looked at again."""
STAGE = "parts_refused"
OF_THE_DISK = "free some disk space"

type KeyOf = Callable[[list[str], Inputs], str]
"""Key of parts that read these parameters and were made of these inputs."""


def refuse_again(out: Out, key_of: KeyOf) -> None:
    """Raise the UserError that was remembered, if nothing has changed that it follows from."""
    stage = Stage(out, STAGE, "", [])
    notes = stage.notes()
    reads, inputs, words = notes.get("parameters"), observed(notes.get("inputs")), notes.get("words")
    if not isinstance(reads, list) or not inputs or not isinstance(words, str):
        return
    if Stage(out, STAGE, key_of(reads, inputs), []).is_fresh():
        again = f"{to_run('parts', out.name)} {said(anyway='1').replace(' 1', '')}"
        raise UserError(f"{words} (nothing has changed since this was found; {again} looks for it anew)")


def is_worth_it(error: UserError, seconds: float) -> bool:
    """Whether a refusal took long to find, and is not of the disk or another process, which may be gone next time."""
    passing = error.code == BUSY or isinstance(error.__cause__, OSError) or OF_THE_DISK in str(error)
    return seconds >= LONG and not passing


def remember(out: Out, error: UserError, key: str, reads: list[str], inputs: Inputs) -> None:
    """Remember that parts with this key were refused."""
    notes: dict[str, Any] = {"parameters": reads, "inputs": inputs.names(), "words": str(error)}
    Stage(out, STAGE, key, []).done(**notes)


def forget(out: Out) -> None:
    """Parts were made, so that nothing is refused any more."""
    Stage(out, STAGE, "", []).stamp.unlink(missing_ok=True)
