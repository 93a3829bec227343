"""Folder layout: the one place that knows where things are."""

from __future__ import annotations

import ast
import os
import re
import shlex
import tempfile
from collections.abc import Iterable
from pathlib import Path

from shared.stage.errors import UserError, did_you_mean
from shared.stage.face import to_run
from shared.stage.memory import recalled
from shared.stage.scale import Scale

ROOT = Path(__file__).resolve().parents[2]
"""The folder that holds the rooms: the clone, or the one that an installed package brings them in."""
SOLVER = ROOT / "mbsd" if (ROOT / "mbsd").is_dir() else ROOT.parent
"""The package ``mbsd``: beside the other rooms in a clone, around them where it is installed."""
WORKSHOP = "MBSD_WORKSHOP"
"""Environment variable that names a user's own folder of machines; without it they are those of the clone."""


def in_workshop() -> bool:
    """Return True if mechanisms are those of a user's own folder."""
    return bool(os.environ.get(WORKSHOP))


def _machines() -> Path:
    own = os.environ.get(WORKSHOP)
    return Path(os.path.abspath(os.path.expanduser(own))) if own else ROOT / "mechanisms"


def work_in(folder: Path) -> None:
    """Use the mechanisms of a user's folder, in this process and in those that it starts.

    Before what loads the author's code is imported, which keeps the folder.
    """
    global MECHANISMS
    os.environ[WORKSHOP] = str(folder)
    MECHANISMS = _machines()


MECHANISMS = _machines()
"""The folder of machines: each a folder with a mechanism.py; in a user's own one also single files, or itself."""
RESERVED = {
    **dict.fromkeys(("stages", "automatic"), "the package of the mechanisms has a module of this name"),
    "out": "out holds the results",
    "films": "out/films holds the films",
    "showreel": "the film of all mechanisms has this name",
    "night": "out/night holds the log of the nights",
    "site": "out/site holds the site",
    "gallery": "out/gallery holds the gallery",
    "docs": "out/docs holds the pages of the documents",
    "engines": "out/engines holds the tables of engine layouts",
    "browsers": "out/browsers holds what was seen of pages in browsers",
    "hunt_parts": "out/hunt_parts holds the cases of hunts",
}
"""Names that no mechanism can have, and why: results of it and of others would be in one folder."""
NAME = re.compile(r"[a-z][a-z0-9_]*")
"""The name of a mechanism: its folder, Python package and make target."""
NAME_RULE = "write lower-case letters, digits and underscores (or hyphens), a letter first"


def out_root() -> Path:
    """Return the folder of all results.

    It is ``$MBSD_OUT`` if set, else ``out`` in the clone or in the user's folder.
    """
    return Path(os.environ.get("MBSD_OUT") or (MECHANISMS if in_workshop() else ROOT) / "out")


def cache_roots() -> list[Path]:
    """Return the folders of caches, the one to write to first.

    ``.cache`` in the clone, or the user's cache folder; both where the clone is another user's, which is then read.
    """
    clones = [ROOT / ".cache"] if (ROOT / "Makefile").is_file() else []
    if clones and _is_writable(clones[0]):
        return clones
    return [Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "mbsd", *clones]


def _is_writable(folder: Path) -> bool:
    """Return True if this user may write into a folder, or create it."""
    try:
        folder.mkdir(exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def refuse_links(path: Path) -> None:
    """Raise UserError if ``path`` or a folder above it, inside :func:`out_root`, is a symbolic link.

    The message names the link.

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
    """Return the name with underscores: ``four-bar`` and ``four_bar`` are one mechanism."""
    return name.strip().strip("/").replace("-", "_")


def mechanism_name(name: str) -> str:
    """Return the canonical name: ``slider_crank-no_gravity`` for a variant.

    Raises UserError if it is none, so that no path or command is made of it, and if it may mean two variants.
    """
    canonical = canonical_name(name)
    if not NAME.fullmatch(canonical):
        known = mechanism_names()
        raise UserError(
            f"{name!r} is not the name of a mechanism: {NAME_RULE}; there is: {', '.join(known) or 'none'}"
            f"{did_you_mean(canonical, known)}"
        )
    if _source(canonical) is not None:
        return canonical
    meant = [
        f"{owner}-{variant}"
        for owner in mechanism_names()
        if canonical.startswith(f"{owner}_")
        for variant in _variants_of(owner)
        if canonical == f"{owner}_{variant}"
    ]
    if len(meant) > 1:
        raise UserError(f"'{name}' may be {' or '.join(meant)}; give one of these variants another name in VARIANTS")
    return meant[0] if meant else canonical


def owner_of(name: str) -> str:
    """Return the mechanism of a name: ``slider_crank`` of ``slider_crank-no_gravity``.

    Raises UserError if it is none.
    """
    return mechanism_name(name).partition("-")[0]


def variant_of(name: str) -> str | None:
    """Return the variant of a name: ``no_gravity`` of ``slider_crank-no_gravity``; None if it has none."""
    return mechanism_name(name).partition("-")[2] or None


def variants_in(file: Path) -> list[str]:
    """Return the names in ``VARIANTS = {...}`` of a mechanism.py, read without running it.

    There are none if it does not parse.
    """
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
    """Return a mechanism's variants, for comparing pages; raises UserError for one without."""
    owner = owner_of(name)
    variants = variants_in(mechanism_file(owner))
    if not variants:
        raise UserError(
            f'{owner}: there is nothing to compare; write VARIANTS = {{"name": {{"field": value}}}} beside build() in '
            f"{shown_file(owner)}, each with the fields of Params that it replaces"
        )
    return variants


def mechanism_names() -> list[str]:
    """Return every mechanism: a folder with a fit name that holds a ``mechanism.py``.

    In a user's own folder also a file with a function ``build``, and that folder itself.
    """
    return [name for name in _names() if NAME.fullmatch(name) and name not in RESERVED]


def planar_names() -> list[str]:
    """Return the mechanisms in the plane: some tests have no others yet."""
    return planar_among(mechanism_names())


def planar_among(names: Iterable[str]) -> list[str]:
    """Return the mechanisms that do not import mbsd.spatial; their files are read, not run."""
    return [name for name in names if not imports_space(mechanism_file(name))]


def imports_space(file: Path) -> bool:
    """Return True if a mechanism.py imports mbsd.spatial; it need not parse."""
    text = file.read_text("utf-8", errors="replace")
    return re.search(r"^\s*(from|import)\s+mbsd\.spatial\b", text, re.MULTILINE) is not None


def all_mechanisms() -> list[str]:
    """Return :func:`mechanism_names`. Raises UserError saying where none are and how to add one."""
    names, unfit = mechanism_names(), unfit_names()
    if not names:
        where = MECHANISMS if in_workshop() else "mechanisms/"
        left = "".join(f"; {name!r} is left out, because that cannot name a mechanism: {unfit[name]}" for name in unfit)
        raise UserError(f"there are no mechanisms in {where}; {to_run('new', 'excavator')} makes one{left}")
    return names


def unfit_names() -> dict[str, str]:
    """Return names that hold a mechanism but cannot be the name of one, with the reason."""
    return {name: RESERVED.get(name, NAME_RULE) for name in _names() if not NAME.fullmatch(name) or name in RESERVED}


def _names() -> list[str]:
    names = {path.parent.name for path in MECHANISMS.glob("*/mechanism.py")}
    if in_workshop():
        names |= {
            path.stem for path in MECHANISMS.glob("*.py") if path.name != "mechanism.py" and defines(path, "build")
        }
        if (MECHANISMS / "mechanism.py").is_file():
            names.add(name_of_folder(MECHANISMS))
    return sorted(names)


def name_of_folder(folder: Path) -> str:
    """Return the name of a mechanism whose mechanism.py lies in the user's folder itself."""
    name = re.sub(r"[^a-z0-9]+", "_", folder.name.lower()).strip("_")
    return name if NAME.fullmatch(name) and name not in RESERVED else f"machine_{name}".rstrip("_")


def defines(file: Path, name: str) -> bool:
    """Return True if a Python file defines this name at its top level; it need not parse."""
    try:
        text = file.read_text("utf-8", errors="replace")
    except OSError:
        return False
    return re.search(rf"^(def\s+{name}\b|{name}\s*[:=])", text, re.MULTILINE) is not None


def _source(owner: str) -> Path | None:
    """Return the file that defines this mechanism's model, None if there is none."""
    if owner in RESERVED:
        return None
    file = MECHANISMS / owner / "mechanism.py"
    if file.is_file():
        return file
    if not in_workshop():
        return None
    if (single := MECHANISMS / f"{owner}.py").is_file():
        return single
    own = MECHANISMS / "mechanism.py"
    return own if own.is_file() and owner == name_of_folder(MECHANISMS) else None


def _is_twofold(source: Path) -> bool:
    """Return True if a file beside the folder of a mechanism has its name and defines one, too."""
    single = MECHANISMS / f"{source.parent.name}.py"
    return in_workshop() and source.parent != MECHANISMS and single.is_file() and defines(single, "build")


def is_single_file(name: str) -> bool:
    """Return True if a mechanism is a single file, ``excavator.py``."""
    source = _source(owner_of(name))
    return source is not None and source.name != "mechanism.py"


def mechanism_file(name: str, file: str = "mechanism") -> Path:
    """Return the file that holds ``mechanism``, ``parts`` or ``shot`` of a mechanism or variant.

    It need not exist.

    Raises UserError as :func:`mechanism_folder`.
    """
    folder = mechanism_folder(name)
    return folder / f"{owner_of(name)}.py" if is_single_file(name) else folder / f"{file}.py"


def shown_file(name: str, file: str = "mechanism") -> str:
    """Return the file as users know it: ``mechanisms/four_bar/parts.py``, ``excavator.py``.

    The name may be unknown or none.
    """
    owner = name.partition("-")[0]
    if not in_workshop():
        return f"mechanisms/{owner}/{file}.py"
    source = _source(owner)
    if source is None or source.parent != MECHANISMS:
        return f"{owner}/{file}.py"
    return f"{file}.py" if source.name == "mechanism.py" else source.name


def _variants_of(owner: str) -> list[str]:
    source = _source(owner)
    return variants_in(source) if source is not None else []


def mechanism_folder(name: str) -> Path:
    """Return the folder of a mechanism, also for its variant.

    Raises UserError with the known names if there is none.
    """
    source = _source(owner_of(name))
    if source is not None and source.name == "mechanism.py" and _is_twofold(source):
        owner = owner_of(name)
        raise UserError(f"{owner}/mechanism.py and {owner}.py in {MECHANISMS} have the same name; rename one of them")
    if source is None:
        known, name = mechanism_names(), mechanism_name(name)
        if name in RESERVED and name in unfit_names():
            raise UserError(f"'{name}' cannot name a mechanism, because {RESERVED[name]}; give it another name")
        _refuse_unknown_variant(name, known)
        raise UserError(
            f"there is no mechanism '{name}' in {MECHANISMS if in_workshop() else 'mechanisms/'}; there is: "
            f"{', '.join(known) or 'none'}{did_you_mean(name, known)}"
        )
    return source.parent


def known_name(name: str) -> str:
    """Return the canonical name of an existing mechanism or variant.

    Raises UserError as :func:`mechanism_folder`.
    """
    mechanism_folder(name)
    return mechanism_name(name)


def _refuse_unknown_variant(name: str, known: Iterable[str]) -> None:
    """Raise UserError if ``name`` begins with a mechanism but is none of its variants."""
    for owner in sorted(known, key=len, reverse=True):
        variants = _variants_of(owner)
        if name.startswith(f"{owner}_") and variants:
            other = name.removeprefix(f"{owner}_")
            raise UserError(
                f"{owner} has no variant '{other}'; its VARIANTS are: {', '.join(variants)}"
                f"{did_you_mean(other, variants)}"
            )


class Out:
    """Result files of one mechanism or variant under :func:`out_root`.

    Results of its model at a scale are in a folder below. Raises UserError if ``name`` is no name.
    """

    def __init__(self, name: str, scale: Scale | None = None) -> None:
        self.name = mechanism_name(name)
        self.title = self.name if scale is None else f"{self.name} at {scale}"
        self.folder = out_root() / self.name / (scale.slug if scale else "")
        self.motion = self.folder / "data.json"
        self.skeleton = self.folder / "skeleton.json"
        self.parts_folder = self.folder / "parts"
        self.parts = self.parts_folder / "parts.json"
        self.clearance = self.folder / "clearance.json"
        self.print_folder = self.folder / "print"
        self.plate = f"{scale.slug}_plate" if scale else "plate"
        self.shot = self.folder / "shot.json"
        self.plots = self.folder / "plots"
        self.compare = self.folder / "compare"
        self.glb = self.folder / f"{self.name}.glb"
        self.view = self.folder / "view.html"
        self.article = self.folder / "article.html"
        self.designs = self.folder / "designs.bin"
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
        """Return the folder of the frames of one preset, named by what they show."""
        return self.all_frames / preset

    def animation(self, view: str, suffix: str) -> Path:
        """Return the moving skeleton; ``view`` names its part, empty for all of it side by side."""
        return self.folder / f"animation{'-' * bool(view)}{view}{suffix}"

    def film(self, preset: str) -> Path:
        """Return the finished film of one preset."""
        return out_root() / "films" / f"{self.name}-{preset}.mp4"
