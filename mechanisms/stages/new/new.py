"""``make new NAME=my_linkage KIND=driven``: the files of a mechanism, ready to run and to be changed."""

from __future__ import annotations

import keyword
import os
import re
import tempfile
from pathlib import Path

from shared.stage.console import say
from shared.stage.errors import UserError, did_you_mean
from shared.stage.face import to_run
from shared.stage.files import write_bytes
from shared.stage.paths import (
    MECHANISMS,
    NAME,
    NAME_RULE,
    RESERVED,
    canonical_name,
    in_workshop,
    mechanism_names,
    shown_file,
)

TEMPLATES = Path(__file__).parent / "templates"
KINDS = {"driven": "a slider-crank turned by a driver", "simulated": "a double pendulum moved by weight and a spring"}
"""Folders of templates, and what is in them."""
TAKEN = {**RESERVED, "all": f"{to_run('all')} runs every mechanism"}
NEW = to_run("new", "my_linkage")


def run(name: str, kind: str = "driven", single: bool = False) -> None:
    """Write the files of a mechanism, with comments; ``kind`` is one of :data:`KINDS`.

    They come into ``mechanisms/<name>/``, or ``<name>/`` of the user's folder; ``single``: there into ``<name>.py``.

    Raises UserError for a missing, unfit or used name and for an unknown kind; nothing that exists is changed.
    """
    name = canonical_name(name)
    if kind not in KINDS:
        known = "; ".join(f"{word}: {what}" for word, what in KINDS.items())
        raise UserError(f"there is no kind '{kind}' of new mechanism; {known}{did_you_mean(kind, KINDS)}")
    refuse_unfit(name)
    if single:
        _write_single(name, kind)
        return
    folder = MECHANISMS / name
    # All files or none: the folder gets its name when it is complete.
    with tempfile.TemporaryDirectory(prefix=".new-", dir=MECHANISMS) as temporary:
        draft = Path(temporary) / name
        for template in sorted((TEMPLATES / kind).glob("*.py.txt")):
            write_bytes(draft / template.name.removesuffix(".txt"), _filled(template, name))
        os.rename(draft, folder)
    _tell(f"{folder.relative_to(MECHANISMS if in_workshop() else MECHANISMS.parent)}/", name, kind)


def _write_single(name: str, kind: str) -> None:
    write_bytes(file_of(name, single=True), _filled(TEMPLATES / kind / "mechanism.py.txt", name))
    _tell(f"{name}.py", name, kind)


def file_of(name: str, single: bool) -> Path:
    """Return where the model of a new mechanism goes; raises UserError for a single file in the clone."""
    if single and not in_workshop():
        raise UserError("a mechanism of the clone is a folder; leave --single out, or work in a folder of your own")
    return MECHANISMS / f"{name}.py" if single else MECHANISMS / name / "mechanism.py"


def mark_folder() -> None:
    """Write a mbsd.toml into a user's folder that has none: commands given in a folder below find it."""
    settings = MECHANISMS / "mbsd.toml"
    if in_workshop() and not settings.exists():
        write_bytes(settings, (TEMPLATES / "mbsd.toml.txt").read_bytes())


def _filled(template: Path, name: str) -> bytes:
    text = template.read_text().replace("@NAME@", name)
    return re.sub("@([a-z]+)([a-z-]*)@", lambda word: to_run(word[1], f"{name}{word[2]}"), text).encode()


def _tell(where: str, name: str, kind: str) -> None:
    mark_folder()
    say("new", f"{where}: {KINDS[kind]}, to change; {to_run('run', name)} runs it")


def refuse_unfit(name: str) -> None:
    """Raise UserError unless ``name`` can be a new mechanism's folder, Python package and make target."""
    known = ", ".join(mechanism_names()) or "none"
    if not name:
        raise UserError(f"a new mechanism needs a name: {NEW}; there is already: {known}")
    if not NAME.fullmatch(name):
        raise UserError(f"{name!r} cannot name a mechanism: {NAME_RULE}, as in {NEW}")
    if keyword.iskeyword(name) or keyword.issoftkeyword(name):
        raise UserError(f"'{name}' is a word of Python and cannot name a mechanism; try {name}_linkage")
    if name in TAKEN:
        raise UserError(f"'{name}' cannot name a mechanism, because {TAKEN[name]}; try {name}_linkage")
    if name.startswith("ui_"):
        raise UserError(f"'{name}' cannot name a mechanism, because scene-ui-<name> opens scenes; drop the ui_")
    if name in mechanism_names():
        raise UserError(f"{shown_file(name)} is there already; choose another name than: {known}")
    if (MECHANISMS / name).exists() or (MECHANISMS / f"{name}.py").exists():
        raise UserError(
            f"{MECHANISMS.name}/ has a file or folder '{name}' already, which is no mechanism; choose another name"
        )
