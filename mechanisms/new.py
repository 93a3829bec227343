"""``make new NAME=my_linkage``: a mechanism's three files, ready to run and to be changed."""

from __future__ import annotations

import keyword
import os
import tempfile
from pathlib import Path

from shared.console import say
from shared.errors import UserError
from shared.files import write_bytes
from shared.paths import MECHANISMS, NAME, NAME_RULE, canonical_name, mechanism_names

TEMPLATES = Path(__file__).parent / "new_templates"
PLACEHOLDER = "@NAME@"
TAKEN = {"all": "make run-all runs every mechanism", "films": "out/films holds the films"}


def run(name: str) -> None:
    """Write ``mechanisms/<name>/{mechanism,parts,shot}.py``: a slider-crank with comments.

    Raises UserError for a missing, unfit or used name; nothing that exists is touched.
    """
    name = canonical_name(name)
    refuse_unfit(name)
    folder = MECHANISMS / name
    # All three files or none: the folder gets its name when it is complete.
    with tempfile.TemporaryDirectory(prefix=".new-", dir=MECHANISMS) as temporary:
        draft = Path(temporary) / name
        for template in sorted(TEMPLATES.glob("*.py.txt")):
            content = template.read_text().replace(PLACEHOLDER, name)
            write_bytes(draft / template.name.removesuffix(".txt"), content.encode())
        os.rename(draft, folder)
    target = name.replace("_", "-")
    say("new", f"{folder.relative_to(MECHANISMS.parent)}/: a slider-crank to change; make run-{target} runs it")


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
