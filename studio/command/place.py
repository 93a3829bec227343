"""Place in which a command works: the clone, or the user's nearest folder with ``mbsd.toml``."""

from __future__ import annotations

import codecs
import os
from dataclasses import dataclass
from pathlib import Path

import msgspec

from shared.stage.errors import UserError
from shared.stage.face import is_of_make
from shared.stage.paths import ROOT, name_of_folder

# ``mbsd.toml``: settings of a user's folder for all its mechanisms.


FILE = "mbsd.toml"
LARGEST = 16_384
"""Bytes of the file, at most: tomllib takes minutes for a key of a hundred thousand parts."""


class Settings(msgspec.Struct, forbid_unknown_fields=True, kw_only=True, rename="kebab"):
    """Values of the file; each is the default of the option of the same name."""

    preset: str = ""
    aspect: str = ""
    show: str = ""
    sound: str = ""
    spectra: str = ""
    bed: str = ""
    gap: float | None = None
    """mm"""
    scale: str = ""
    """Scale of models that are printed: 1:20."""
    watts: float | None = None
    look: str = ""
    """Look of machines whose shot names none."""
    out: str = ""
    """Folder of results, from the file's own folder; ``out`` where it is not said."""
    cluster: str = ""
    """Address of a scheduler: tcp://name:8786."""
    cluster_tls: str = ""
    """Folder of its certificates, from the file's own folder."""

    def word(self, option: str) -> str:
        """Return the value of an option; empty if the file has none."""
        value = getattr(self, option.replace("-", "_"), None)
        return "" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def read(folder: Path) -> Settings:
    """Return the settings of a folder, empty ones without a file. Raises UserError for an invalid file."""
    file = folder / FILE
    try:
        with file.open("rb") as stream:
            content = stream.read(LARGEST + 1)
    except FileNotFoundError:
        return Settings()
    except OSError as error:
        raise UserError(f"{file} cannot be read: {error.strerror}") from error
    if len(content) > LARGEST:
        raise UserError(f"{file} is larger than {LARGEST // 1024} kB; {_known()}")
    try:
        settings = msgspec.toml.decode(content.removeprefix(codecs.BOM_UTF8), type=Settings)
    except RecursionError as error:
        raise UserError(f"{file}: it is nested too deeply; {_known()}") from error
    except (msgspec.DecodeError, ValueError) as error:  # a number of 5000 digits is a ValueError
        raise UserError(f"{file}: {error}; {_known()}") from error
    for field in msgspec.structs.fields(Settings):
        value = getattr(settings, field.name)
        if isinstance(value, str) and not value.isprintable():
            raise UserError(f"{file}: {field.encode_name} is {value!r}, with characters that cannot be printed")
    return settings


def _known() -> str:
    return f"its fields are: {', '.join(field.encode_name for field in msgspec.structs.fields(Settings))}"


# Place in which a command works: the clone, or the nearest folder of the user's own.


@dataclass(frozen=True)
class Place:
    """Folder of mechanisms with its settings; ``machines`` is None in the clone, which has its own."""

    machines: Path | None
    settings: Settings
    inside: str = ""
    """The machine's folder in which the command was given, if it was given in one."""

    def environment(self) -> dict[str, str]:
        """Return what the place adds to the environment of the stages."""
        words: dict[str, str] = {}
        if self.machines is not None:
            words["MBSD_WORKSHOP"] = str(self.machines)
            if self.settings.out and "MBSD_OUT" not in os.environ:
                words["MBSD_OUT"] = str(self.machines / os.path.expanduser(self.settings.out))
        plain = {"CLUSTER": self.settings.cluster, "MBSD_LOOK": self.settings.look}
        words |= {variable: value for variable, value in plain.items() if value and not os.environ.get(variable)}
        if self.settings.cluster_tls and not os.environ.get("CLUSTER_TLS"):
            words["CLUSTER_TLS"] = str((self.machines or ROOT) / os.path.expanduser(self.settings.cluster_tls))
        return words


def place_of(folder: Path) -> Place:
    """Return the place of a command that is given in ``folder``.

    It is the clone if ``folder`` lies there or make is at work, else the nearest folder above with a mbsd.toml, else
    ``folder`` itself. Raises UserError for an invalid mbsd.toml.
    """
    folder = Path(os.path.abspath(os.path.expanduser(folder)))
    _refuse_none(folder)
    named = os.environ.get("MBSD_WORKSHOP") or (os.environ.get("MECHANISMS") if is_of_make() else None)
    if named:
        machines = Path(os.path.abspath(os.path.expanduser(named)))
        _refuse_none(machines)
        return Place(machines, read(machines), _inside(folder, machines))
    if is_of_make():
        return Place(None, read(ROOT))
    for above in (folder, *folder.parents):
        if (above / FILE).is_file() and above != ROOT:
            return Place(above, read(above), _inside(folder, above))
        if above == ROOT and (ROOT / "Makefile").is_file():
            return Place(None, read(ROOT), _inside(folder, ROOT / "mechanisms"))
    return Place(folder, Settings())


def is_path(operand: str) -> bool:
    """True if an operand is the path of a mechanism, as a shell completes it, and not its name."""
    return operand.endswith(".py") or os.sep in operand or operand in (".", "..")


def place_of_file(folder: Path, operand: str) -> tuple[Place, str]:
    """Return the place and the name of the mechanism at a path: ``lamp.py``, ``./lamp.py``, ``lamp/``.

    ``operand`` is relative to ``folder``. The place is that of ``folder`` if it holds the mechanism, else that of the
    folder which does. Raises UserError if there is no mechanism at the path.
    """
    path = Path(os.path.abspath(folder / os.path.expanduser(operand)))
    if path.is_file() and (path.parent / "mechanism.py").is_file():
        path = path.parent
    if not (path.is_file() and path.suffix == ".py") and not (path / "mechanism.py").is_file():
        what = "has no mechanism.py" if path.is_dir() else "is not a file or folder of a mechanism"
        raise UserError(f"{operand} {what}; give the name or the path of a mechanism, such as lamp, lamp.py or lamp/")
    for place in (place_of(folder), place_of(path.parent), place_of(path if path.is_dir() else path.parent)):
        machines = place.machines or ROOT / "mechanisms"
        if path.parent == machines:
            return place, path.stem if path.is_file() else path.name
        if path == machines:
            return place, name_of_folder(path)
    raise UserError(f"{operand} is outside of the folder of mechanisms, {machines}; run the command in its own folder")


def _refuse_none(folder: Path) -> None:
    if not folder.is_dir():
        raise UserError(f"{folder} is not a folder; give the folder of the mechanisms")


def _inside(folder: Path, machines: Path) -> str:
    if folder != machines and folder.is_relative_to(machines):
        name = folder.relative_to(machines).parts[0]
        if (machines / name / "mechanism.py").is_file():
            return name
    return ""
