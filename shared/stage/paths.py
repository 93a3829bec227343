"""Where things are: the one place that knows the folder layout."""

from __future__ import annotations

import ast
import os
import re
import shlex
from collections.abc import Iterable
from pathlib import Path

from shared.stage.errors import UserError
from shared.stage.memory import recalled
from shared.stage.suggestions import did_you_mean

ROOT = Path(__file__).resolve().parents[2]
MECHANISMS = ROOT / "mechanisms"
NAME = re.compile(r"[a-z][a-z0-9_]*")
"""The name of a mechanism: its folder, Python package and make target."""
NAME_RULE = "write lower-case letters, digits and underscores (or hyphens), a letter first"


def out_root() -> Path:
    """The folder of all results: ``$MBSD_OUT`` if set, else ``out`` in the project."""
    return Path(os.environ.get("MBSD_OUT") or ROOT / "out")


def refuse_links(path: Path) -> None:
    """Raise UserError naming the link if ``path`` or a folder above it, inside :func:`out_root`, is a symbolic link.

    Stages overwrite and delete what is no longer theirs in these folders, so they must not lead to files of others.
    :func:`out_root` itself and what is above it may be links: that is how results go to another disk.
    """
    recalled(("no link", path, os.environ.get("MBSD_OUT")), lambda: _refuse_links(path))


def _refuse_links(path: Path) -> str:
    root = Path(os.path.abspath(out_root()))
    path = Path(os.path.abspath(path))
    below = [path, *path.parents][: len(path.parts) - len(root.parts)] if path.is_relative_to(root) else []
    for place in reversed(below):
        if place.is_symlink():
            raise UserError(
                f"{place} is a link to {os.readlink(place)}; stages overwrite and delete files in this folder, so it "
                f"must not be a link: remove it (rm {shlex.quote(str(place))}). For results on another disk, make "
                f"{root} itself a link or set MBSD_OUT"
            )
    return ""


def canonical_name(name: str) -> str:
    """``four-bar`` and ``four_bar`` are one mechanism; folders use underscores."""
    return name.strip().strip("/").replace("-", "_")


def mechanism_name(name: str) -> str:
    """The canonical name, of a variant with its mechanism's before a hyphen: ``slider_crank-no_gravity``.

    Raises UserError if it is none, so that no path or command is made of it, and if it may mean two variants.
    """
    canonical = canonical_name(name)
    if not NAME.fullmatch(canonical):
        raise UserError(
            f"{name!r} is not the name of a mechanism: {NAME_RULE}; there is: {', '.join(mechanism_names()) or 'none'}"
        )
    if (MECHANISMS / canonical / "mechanism.py").is_file():
        return canonical
    meant = [
        f"{owner}-{variant}"
        for owner in mechanism_names()
        if canonical.startswith(f"{owner}_")
        for variant in variants_in(MECHANISMS / owner / "mechanism.py")
        if canonical == f"{owner}_{variant}"
    ]
    if len(meant) > 1:
        raise UserError(f"'{name}' may be {' or '.join(meant)}; give one of these variants another name in VARIANTS")
    return meant[0] if meant else canonical


def owner_of(name: str) -> str:
    """The mechanism of a name: ``slider_crank`` of ``slider_crank-no_gravity``. Raises UserError if it is none."""
    return mechanism_name(name).partition("-")[0]


def variant_of(name: str) -> str | None:
    """The variant of a name: ``no_gravity`` of ``slider_crank-no_gravity``; None of a mechanism itself."""
    return mechanism_name(name).partition("-")[2] or None


def variants_in(file: Path) -> list[str]:
    """The names in ``VARIANTS = {...}`` of a mechanism.py, read without running it; none where it does not parse."""
    try:
        tree = ast.parse(file.read_bytes())
    except (OSError, SyntaxError, ValueError):
        return []
    for statement in tree.body:
        targets = getattr(statement, "targets", [getattr(statement, "target", None)])
        value = getattr(statement, "value", None)
        if any(isinstance(t, ast.Name) and t.id == "VARIANTS" for t in targets) and isinstance(value, ast.Dict):
            keys = [key.value for key in value.keys if isinstance(key, ast.Constant)]
            return [key for key in keys if isinstance(key, str) and NAME.fullmatch(key)]
    return []


def compared(name: str) -> list[str]:
    """A mechanism's variants, for pages beside each other; raises UserError for one without."""
    owner = owner_of(name)
    variants = variants_in(mechanism_folder(owner) / "mechanism.py")
    if not variants:
        raise UserError(
            f'{owner}: there is nothing to compare; write VARIANTS = {{"name": {{"field": value}}}} beside build() in '
            f"mechanisms/{owner}/mechanism.py, each with the fields of Params that it replaces"
        )
    return variants


def mechanism_names() -> list[str]:
    """Every mechanism: a folder of ``mechanisms/`` with a fit name that holds a ``mechanism.py``."""
    return [name for name in _folders() if NAME.fullmatch(name)]


def unfit_folders() -> list[str]:
    """Names of folders that hold a ``mechanism.py`` but cannot be a mechanism's name."""
    return [name for name in _folders() if not NAME.fullmatch(name)]


def _folders() -> list[str]:
    return sorted(p.parent.name for p in MECHANISMS.glob("*/mechanism.py"))


def mechanism_folder(name: str) -> Path:
    """The folder of a mechanism or of a variant's; raises UserError with the known names if there is none."""
    folder = MECHANISMS / owner_of(name)
    if not (folder / "mechanism.py").is_file():
        known, name = mechanism_names(), mechanism_name(name)
        _refuse_unknown_variant(name, known)
        raise UserError(
            f"there is no mechanism '{name}' in mechanisms/; there is: {', '.join(known) or 'none'}"
            f"{did_you_mean(name, known)}"
        )
    return folder


def known_name(name: str) -> str:
    """The canonical name of a mechanism or variant that is there; raises UserError as :func:`mechanism_folder`."""
    mechanism_folder(name)
    return mechanism_name(name)


def _refuse_unknown_variant(name: str, known: Iterable[str]) -> None:
    """Raise UserError where ``name`` begins with a mechanism that has variants, none of which it is."""
    for owner in sorted(known, key=len, reverse=True):
        variants = variants_in(MECHANISMS / owner / "mechanism.py")
        if name.startswith(f"{owner}_") and variants:
            other = name.removeprefix(f"{owner}_")
            raise UserError(
                f"{owner} has no variant '{other}'; its VARIANTS are: {', '.join(variants)}"
                f"{did_you_mean(other, variants)}"
            )


class Out:
    """The result files of one mechanism or variant under :func:`out_root`; raises UserError if ``name`` is no name."""

    def __init__(self, name: str) -> None:
        self.name = mechanism_name(name)
        self.folder = out_root() / self.name
        self.motion = self.folder / "data.json"
        self.skeleton = self.folder / "skeleton.json"
        self.parts_folder = self.folder / "parts"
        self.parts = self.parts_folder / "parts.json"
        self.clearance = self.folder / "clearance.json"
        self.print_folder = self.folder / "print"
        self.shot = self.folder / "shot.json"
        self.plots = self.folder / "plots"
        self.compare = self.folder / "compare"
        self.glb = self.folder / f"{self.name}.glb"
        self.view = self.folder / "view.html"
        self.report = self.folder / "report.md"
        self.poster = self.folder / "poster.png"
        self.contact = self.folder / "contact.png"
        self.stills = self.folder / "stills"
        self.scene = self.folder / f"{self.name}.blend"
        self.stamps = self.folder / ".stamps"
        self.all_frames = self.folder / "frames"

    def refuse_links(self) -> None:
        """Raise UserError if a folder of this mechanism's results is a link."""
        folders = self.parts_folder, self.print_folder, self.plots, self.compare, self.stills, self.stamps
        for folder in (*folders, self.all_frames):
            refuse_links(folder)

    def frames(self, preset: str) -> Path:
        """The frames of one preset, named by what they show."""
        return self.all_frames / preset

    def animation(self, view: str, suffix: str) -> Path:
        """The moving skeleton; ``view`` names what is shown, empty for all of it side by side."""
        return self.folder / f"animation{'-' * bool(view)}{view}{suffix}"

    def film(self, preset: str) -> Path:
        """The finished film of one preset."""
        return out_root() / "films" / f"{self.name}-{preset}.mp4"
