"""``make new NAME=my_linkage KIND=driven``: the files of a mechanism, ready to run and to be changed."""

from __future__ import annotations

import keyword
import os
import tempfile
from pathlib import Path

from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import MECHANISMS, NAME, NAME_RULE, canonical_name, mechanism_names
from shared.stage.suggestions import did_you_mean

TEMPLATES = Path(__file__).parent / "templates"
KINDS = {
    "driven": "a slider-crank turned by a driver",
    "simulated": "a double pendulum moved by weight and a spring",
}
"""Folders of templates, and what is in them."""
TAKEN = {
    "all": "make run-all runs every mechanism",
    "films": "out/films holds the films",
    "night": "out/night holds the log of the nights",
}


def run(name: str, kind: str = "driven") -> None:
    """Write the files of ``mechanisms/<name>/``, with comments; ``kind`` is one of :data:`KINDS`.

    Raises UserError for a missing, unfit or used name and for an unknown kind; nothing that exists is changed.
    """
    name = canonical_name(name)
    if kind not in KINDS:
        known = "; ".join(f"{word}: {what}" for word, what in KINDS.items())
        raise UserError(f"there is no kind '{kind}' of new mechanism; {known}{did_you_mean(kind, KINDS)}")
    refuse_unfit(name)
    target = name.replace("_", "-")
    folder = MECHANISMS / name
    # All files or none: the folder gets its name when it is complete.
    with tempfile.TemporaryDirectory(prefix=".new-", dir=MECHANISMS) as temporary:
        draft = Path(temporary) / name
        for template in sorted((TEMPLATES / kind).glob("*.py.txt")):
            content = template.read_text().replace("@NAME@", name).replace("@TARGET@", target)
            write_bytes(draft / template.name.removesuffix(".txt"), content.encode())
        os.rename(draft, folder)
    say("new", f"{folder.relative_to(MECHANISMS.parent)}/: {KINDS[kind]}, to change; make run-{target} runs it")


def refuse_unfit(name: str) -> None:
    """Raise UserError unless ``name`` can be a new mechanism's folder, Python package and make target."""
    known = ", ".join(mechanism_names()) or "none"
    if not name:
        raise UserError(f"a new mechanism needs a name: make new NAME=my_linkage; there is already: {known}")
    if not NAME.fullmatch(name):
        raise UserError(f"{name!r} cannot name a mechanism: {NAME_RULE}, as in make new NAME=my_linkage")
    if keyword.iskeyword(name) or keyword.issoftkeyword(name):
        raise UserError(f"'{name}' is a word of Python and cannot name a mechanism; try {name}_linkage")
    if name in TAKEN:
        raise UserError(f"'{name}' cannot name a mechanism, because {TAKEN[name]}; try {name}_linkage")
    if name.startswith("ui_"):
        raise UserError(f"'{name}' cannot name a mechanism, because make scene-ui-<name> opens scenes; drop the ui_")
    if name in mechanism_names():
        raise UserError(f"mechanisms/{name}/ is there already; choose another name than: {known}")
    if (MECHANISMS / name).exists() or (MECHANISMS / f"{name}.py").exists():
        raise UserError(
            f"mechanisms/ has a file or folder '{name}' already, which is no mechanism; choose another name"
        )
