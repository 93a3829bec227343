"""``mbsd.toml``: what a user's folder says once for all its machines."""

from __future__ import annotations

from pathlib import Path

import msgspec

from shared.stage.errors import UserError

FILE = "mbsd.toml"


class Settings(msgspec.Struct, forbid_unknown_fields=True, kw_only=True, rename="kebab"):
    """The file's words; each is what the option of the same name takes where none is given."""

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
        """What is said for an option; empty where nothing is."""
        value = getattr(self, option.replace("-", "_"), None)
        return "" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def read(folder: Path) -> Settings:
    """The settings of a folder; those of an empty file where there is none. Raises UserError for one that is unfit."""
    file = folder / FILE
    try:
        content = file.read_bytes()
    except FileNotFoundError:
        return Settings()
    except OSError as error:
        raise UserError(f"{file} cannot be read: {error.strerror}") from error
    try:
        return msgspec.toml.decode(content, type=Settings)
    except (msgspec.ValidationError, msgspec.DecodeError, UnicodeDecodeError) as error:
        known = ", ".join(field.encode_name for field in msgspec.structs.fields(Settings))
        raise UserError(f"{file}: {error}; it may say: {known}") from error
