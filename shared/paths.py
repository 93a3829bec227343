"""Where things are: the one place that knows the folder layout."""

from __future__ import annotations

import os
from pathlib import Path

from shared.errors import UserError
from shared.suggestions import did_you_mean

ROOT = Path(__file__).resolve().parent.parent
MECHANISMS = ROOT / "mechanisms"


def out_root() -> Path:
    """The folder of all results: ``$MBSD_OUT`` if set, else ``out`` in the project."""
    return Path(os.environ.get("MBSD_OUT") or ROOT / "out")


def canonical_name(name: str) -> str:
    """``four-bar`` and ``four_bar`` are one mechanism; folders use underscores."""
    return name.strip().strip("/").replace("-", "_")


def mechanism_names() -> list[str]:
    """Every mechanism: a folder of ``mechanisms/`` that holds a ``mechanism.py``."""
    return sorted(p.parent.name for p in MECHANISMS.glob("*/mechanism.py"))


def mechanism_folder(name: str) -> Path:
    """The folder of a mechanism; raises UserError with the known names if there is none."""
    folder = MECHANISMS / canonical_name(name)
    if not (folder / "mechanism.py").is_file():
        known = mechanism_names()
        raise UserError(
            f"there is no mechanism '{canonical_name(name)}' in mechanisms/; there is: {', '.join(known) or 'none'}"
            f"{did_you_mean(canonical_name(name), known)}"
        )
    return folder


class Out:
    """The result files of one mechanism under :func:`out_root`."""

    def __init__(self, name: str) -> None:
        self.name = canonical_name(name)
        self.folder = out_root() / self.name
        self.motion = self.folder / "data.json"
        self.parts_folder = self.folder / "parts"
        self.parts = self.parts_folder / "parts.json"
        self.clearance = self.folder / "clearance.json"
        self.shot = self.folder / "shot.json"
        self.plots = self.folder / "plots"
        self.poster = self.folder / "poster.png"
        self.stills = self.folder / "stills"
        self.scene = self.folder / f"{self.name}.blend"
        self.stamps = self.folder / ".stamps"

    def frames(self, preset: str) -> Path:
        """The frames of one preset, named by what they show."""
        return self.folder / "frames" / preset

    def film(self, preset: str) -> Path:
        """The finished film of one preset."""
        return out_root() / "films" / f"{self.name}-{preset}.mp4"
