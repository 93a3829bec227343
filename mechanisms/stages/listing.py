"""``make list``: every mechanism, what it is and what is made of it."""

from __future__ import annotations

import ast

import msgspec

from shared.stage.console import say, warn
from shared.stage.face import to_run
from shared.stage.paths import (
    MECHANISMS,
    NAME_RULE,
    Out,
    in_workshop,
    mechanism_file,
    mechanism_names,
    out_root,
    unfit_names,
    variants_in,
)


class _Diagnostics(msgspec.Struct):
    dof: int


class _Solved(msgspec.Struct):
    diagnostics: _Diagnostics


def run(names: bool = False, as_json: bool = False) -> None:
    """Print a line for each mechanism: name, degrees of freedom (once solved), first line of its docstring, files.

    ``names``: names alone, of variants as well; ``as_json``: all of it for other programs.
    """
    if names:
        print(*_all_names(), sep="\n")
        return
    if as_json:
        print(msgspec.json.encode([_entry(name) for name in _all_names()]).decode())
        return
    if not mechanism_names():
        where = MECHANISMS if in_workshop() else "mechanisms/"
        say("list", f"there are no mechanisms in {where}; {to_run('new', 'excavator')} makes one")
    for name in mechanism_names():
        made = ", ".join(_made(name)) or "nothing yet"
        print(f"{name.replace('_', '-'):<24} {_title(name)}\n{'':<24} {_freedom(name)}made: {made}")
        for variant in variants_in(mechanism_file(name)):
            made = ", ".join(_made(f"{name}-{variant}")) or "nothing yet"
            print(f"{'':<24} {name}-{variant}: made: {made}".replace("_", "-"))
    for folder in unfit_names():
        warn("list", f"{folder!r} is left out, because that cannot name a mechanism: {NAME_RULE}")


def _all_names() -> list[str]:
    """Mechanisms, each followed by its variants."""
    names = []
    for name in mechanism_names():
        names += [name, *(f"{name}-{variant}" for variant in variants_in(mechanism_file(name)))]
    return names


def _entry(name: str) -> dict[str, object]:
    out = Out(name)
    return {
        "name": name,
        "title": _title(name),
        "file": str(mechanism_file(name)),
        "out": str(out.folder),
        "made": _made(name),
    }


def _title(name: str) -> str:
    """First line of mechanism.py's docstring, read without running the file."""
    try:
        docstring = ast.get_docstring(ast.parse((mechanism_file(name)).read_text()))
    except SyntaxError as error:
        return f"({mechanism_file(name).name} does not parse: line {error.lineno}: {error.msg})"
    return (docstring or "(no docstring)").splitlines()[0]


def _freedom(name: str) -> str:
    try:
        dof = msgspec.json.decode(Out(name).motion.read_bytes(), type=_Solved).diagnostics.dof
    except (OSError, msgspec.DecodeError):
        return ""
    return f"{dof} degree{'' if dof == 1 else 's'} of freedom; "


def _made(name: str) -> list[str]:
    out = Out(name)
    files = {"parts": out.parts, "motion": out.motion, "clearance": out.clearance, "shot": out.shot}
    made = [word for word, path in files.items() if path.is_file()]
    if (out.print_folder / "pieces.md").is_file():
        made.append("print")
    if out.animation("", ".mp4").is_file():
        made.append("animation")
    if any(out.plots.glob("*.png")):
        made.append("plots")
    if out.poster.is_file():
        made.append("poster")
    presets = [film.stem.removeprefix(f"{name}-") for film in sorted((out_root() / "films").glob(f"{name}-*.mp4"))]
    return made + [f"film ({preset})" for preset in presets if "-" not in preset]  # else a variant's
