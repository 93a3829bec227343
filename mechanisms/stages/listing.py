"""``make list``: every mechanism, what it is, what is made of it, and what of that is outdated."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import msgspec

from shared.contract.quantity import counted
from shared.stage.console import warn
from shared.stage.errors import UserError
from shared.stage.memory import remembered
from shared.stage.paths import Out, all_mechanisms, mechanism_file, mechanism_names, out_root, unfit_names, variants_in
from shared.stage.stages import outdated_by, results_of


class _Diagnostics(msgspec.Struct):
    dof: int


class _Solved(msgspec.Struct):
    diagnostics: _Diagnostics


def run(names: bool = False, as_json: bool = False) -> None:
    """Print a line for each mechanism: name, degrees of freedom, first line of its docstring, files.

    The freedom is known once it is solved, the title is the first line of its docstring. Results that are older than
    the files or results that they were made of are named apart. No author's code is run, so of parts it is not known.

    ``names``: names alone, of variants as well; ``as_json``: all of it for other programs. Raises UserError if there
    are none, but for other programs.
    """
    if names:
        for name in _all_names():
            print(name)
        return
    if as_json:
        print(msgspec.json.encode([_entry(name) for name in _all_names()]).decode())
        return
    with remembered():
        for name in all_mechanisms():
            print(f"{name.replace('_', '-'):<24} {_title(name)}\n{'':<24} {_freedom(name)}{_made_words(name)}")
            for variant in variants_in(mechanism_file(name)):
                print(f"{'':<24} {name}-{variant}: ".replace("_", "-") + _made_words(f"{name}-{variant}"))
    for name, why in unfit_names().items():
        warn("list", f"{name!r} is left out, because that cannot name a mechanism: {why}")


def tell_current(names: Iterable[str]) -> None:
    """Print a line with the name of each mechanism whose motion, parts and shot are up to date.

    mechanism.py is run for its parameters and may do anything, so this is asked in a process of its own.
    """
    with remembered():
        for name in names:
            if is_current(name):
                print(name, flush=True)


def is_current(name: str) -> bool:
    """Return True if motion, parts and shot that are there follow from the author's files as they are."""
    from mechanisms.stages import shot as shot
    from mechanisms.stages.parts import stage as parts
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
    """Return mechanisms, each followed by its variants."""
    names = []
    for name in mechanism_names():
        names += [name, *(f"{name}-{variant}" for variant in variants_in(mechanism_file(name)))]
    return names


def _entry(name: str) -> dict[str, object]:
    out = Out(name)
    made = _products(out)
    return {
        "name": name,
        "title": _title(name),
        "file": str(mechanism_file(name)),
        "out": str(out.folder),
        "made": list(made),
        "older": _older(out, made),
    }


def _title(name: str) -> str:
    """Return the first line of mechanism.py's docstring, read without running the file."""
    try:
        docstring = ast.get_docstring(ast.parse(mechanism_file(name).read_bytes()))
    except SyntaxError as error:
        return f"({mechanism_file(name).name} does not parse: line {error.lineno}: {error.msg})"
    return (docstring or "(no docstring)").splitlines()[0]


def _freedom(name: str) -> str:
    try:
        dof = msgspec.json.decode(Out(name).motion.read_bytes(), type=_Solved).diagnostics.dof
    except (OSError, msgspec.DecodeError):
        return ""
    return f"{counted(dof, 'degree')} of freedom; "


def _made_words(name: str) -> str:
    """``made: parts, motion; of an older version: poster``."""
    out = Out(name)
    made = _products(out)
    older = _older(out, made)
    words = f"made: {', '.join(word for word in made if word not in older) or 'nothing yet'}"
    return f"{words}; of an older version: {', '.join(older)}" if older else words


def _products(out: Out) -> dict[str, Path]:
    """Return what is there of a mechanism, with the file that stands for it."""
    files = {
        "parts": out.parts,
        "motion": out.motion,
        "clearance": out.clearance,
        "shot": out.shot,
        "print": out.print_folder / "pieces.md",
        "animation": out.animation("", ".mp4"),
        "plots": min(out.plots.glob("*.png"), default=out.plots / "none"),
        "poster": out.poster,
    }
    for film in sorted((out_root() / "films").glob(f"{out.name}-*.mp4")):
        preset = film.stem.removeprefix(f"{out.name}-")
        if "-" not in preset:  # else a variant's
            files[f"film ({preset})"] = film
    return {word: path for word, path in files.items() if path.is_file()}


def _older(out: Out, made: Mapping[str, Path]) -> list[str]:
    """Return the results that are older than what they were made of."""
    from mechanisms.stages import shot as shot
    from mechanisms.stages.solve import stage as solve

    stale = set() if _is_fresh(solve.is_fresh, out) else {out.motion, out.skeleton, out.animation("", ".mp4")}
    stale |= set() if not out.shot.is_file() or _is_fresh(shot.is_fresh, out) else {out.shot}
    return [word for word, path in made.items() if path in stale or _is_outdated(out, path, stale)]


def _is_outdated(out: Out, path: Path, stale: set[Path]) -> bool:
    """Return True if a result was made of an older one, or of one that is ``stale`` itself."""
    read = results_of(out, path)
    return bool(read and (read & stale or outdated_by(out, path)))


def _is_fresh(is_fresh: Callable[[str], bool], out: Out) -> bool:
    try:
        return is_fresh(out.name)
    except (UserError, OSError):
        return False  # the stage tells why
