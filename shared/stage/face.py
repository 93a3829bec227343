"""Commands in messages, as the user typed them: ``mbsd`` or make."""

from __future__ import annotations

import os

VARIABLE = "MBSD_FACE"
"""Environment variable in which the program ``mbsd`` says that it is the one."""
PROGRAM = "mbsd"


def to_run(command: str, name: str = "") -> str:
    """Return ``make poster-four-bar`` or ``mbsd poster four-bar``; ``name`` may be empty."""
    shown = name.replace("_", "-")
    if _is_program():
        return " ".join(("mbsd", command, *filter(None, [shown])))
    return f"make {command} NAME={name}" if command == "new" else f"make {command}{'-' * bool(shown)}{shown}"


def said(**words: str) -> str:
    """Return ``PRESET=final ASPECT=9:16`` or ``--preset final --aspect 9:16``.

    An empty value is that of a flag.
    """
    if _is_program():
        return " ".join(f"--{key} {value}".rstrip() for key, value in words.items())
    return " ".join(f"{key.upper()}={value or 1}" for key, value in words.items())


def is_of_make() -> bool:
    """Return True if the command was given to the Makefile."""
    return os.environ.get(VARIABLE) == "make"


def _is_program() -> bool:
    return os.environ.get(VARIABLE) == PROGRAM
