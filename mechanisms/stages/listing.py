"""``make list``: every mechanism, what it is, what is made of it, and what of that is of an older version."""

from __future__ import annotations

import ast
from collections.abc import Iterable

import msgspec

from shared.stage.console import warn
from shared.stage.errors import UserError
from shared.stage.memory import remembered
from shared.stage.paths import NAME_RULE, Out, mechanism_file, mechanism_names, out_root, unfit_names, variants_in


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
    for name in mechanism_names():
        made = ", ".join(_made(name)) or "nothing yet"
        print(f"{name.replace('_', '-'):<24} {_title(name)}\n{'':<24} {_freedom(name)}made: {made}")
        for variant in variants_in(mechanism_file(name)):
            made = ", ".join(_made(f"{name}-{variant}")) or "nothing yet"
            print(f"{'':<24} {name}-{variant}: made: {made}".replace("_", "-"))
    for folder in unfit_names():
        warn("list", f"{folder!r} is left out, because that cannot name a mechanism: {NAME_RULE}")


def tell_current(names: Iterable[str]) -> None:
    """Print the names whose motion, parts and shot follow from the author's files as they are, a line each.

    mechanism.py is run for its parameters and may do anything, so this is asked in a process of its own.
    """
    with remembered():
        for name in names:
            if is_current(name):
                print(name, flush=True)


def is_current(name: str) -> bool:
    """Whether motion, parts and shot that are there follow from the author's files as they are."""
    from mechanisms.stages.parts import stage as parts
    from mechanisms.stages.shot import stage as shot
    from mechanisms.stages.solve import stage as solve

    out = Out(name)
    try:
        return (
            solve.is_fresh(name)
            and (not out.shot.is_file() or shot.is_fresh(name))
            and (not out.parts.is_file() or parts.are_current(name))
        )
    except (UserError, OSError):
        return False  # the stage tells why


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
