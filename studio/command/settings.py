"""``mbsd.toml``: settings of a user's folder for all its mechanisms."""

from __future__ import annotations

import codecs
from pathlib import Path

import msgspec

from shared.stage.errors import UserError

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
        raise UserError(f"{file}: it is nested too deep; {_known()}") from error
    except (msgspec.DecodeError, ValueError) as error:  # a number of 5000 digits is a ValueError
        raise UserError(f"{file}: {error}; {_known()}") from error
    for field in msgspec.structs.fields(Settings):
        value = getattr(settings, field.name)
        if isinstance(value, str) and not value.isprintable():
            raise UserError(f"{file}: {field.encode_name} is {value!r}, with characters that cannot be printed")
    return settings


def _known() -> str:
    return f"it may say: {', '.join(field.encode_name for field in msgspec.structs.fields(Settings))}"
