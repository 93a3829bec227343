"""Inputs of the picture stages, and the key that changes with them. Cheap to import."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

from render.presets import ASPECT, Preset
from shared.stage.errors import UserError
from shared.stage.files import sources_hash
from shared.stage.memory import recalled
from shared.stage.paths import Out, mechanism_folder
from shared.stage.stages import contract_sources, key_of

if TYPE_CHECKING:
    from render.film.film import Film

SHARED = ("clearance", "geometry", "links", "materials", "quantity", "quaternions", "shot", "signals")
"""Files of shared/contract/, beside those of motion and parts, that decide what is seen."""
STAGE_OF = {"motion": "solve", "parts": "parts", "shot": "run"}


def refuse_missing(out: Out) -> None:
    """Raise UserError naming the make target if a file is not there yet."""
    if not out.folder.is_dir():
        mechanism_folder(out.name)
    for attribute, target in STAGE_OF.items():
        path = getattr(out, attribute)
        if not path.is_file():
            raise UserError(f"{out.name}: {path} is missing; run make {target}-{out.name.replace('_', '-')} first")


def stage_key(out: Out, preset: Preset, *more: object) -> str:
    """Return the key of a picture stage: the three files, our sources, the preset, Blender's version."""
    refuse_missing(out)
    return key_of(out.motion, out.parts, out.shot, picture_sources(), preset, blender_version(), *more)


def named(path: Path, show: str, suffix: str = "") -> Path:
    """Return the path of a picture with SHOW: ``poster-forces-title.png`` beside ``poster.png``.

    ``suffix`` is that of a preset in another aspect, where the path has not the preset's name: ``poster-9x16.png``.
    """
    path = path.with_stem(path.stem + suffix)
    return path.with_stem("-".join([path.stem, *show.split(",")])) if show else path


def encoder_version() -> str:
    """Return the version of the package that brings ffmpeg; empty where the system's own is used."""
    try:
        return recalled(("version", "imageio-ffmpeg"), lambda: metadata.version("imageio-ffmpeg"))
    except metadata.PackageNotFoundError:
        return ""


def picture_sources() -> str:
    """Return the hash of the sources that make pictures; the plots are not among them."""
    room = Path(__file__).parents[1]
    rooms = [room / name for name in ("presets.py", "letters.py", "looks.py", "film", "frames", "blender")]
    return sources_hash(*rooms, *contract_sources(*SHARED))


def blender_version() -> str:
    """Return the version of bpy, without its two seconds of import."""
    try:
        return recalled(("version", "bpy"), lambda: metadata.version("bpy"))
    except metadata.PackageNotFoundError:
        raise UserError("bpy (Blender as a module) is not installed; run make install") from None


def read_film(out: Out, show: str = "", aspect: float = ASPECT) -> Film:
    """Read and check data.json, parts.json and shot.json.

    ``show`` replaces the SHOW of the shot, and the film is framed for pictures of that ``aspect``, width over height.
    """
    from render.film.film import Film
    from shared.contract import Motion, read_any_motion, read_parts
    from shared.contract.geometry import with_rods
    from shared.contract.links import with_links
    from shared.contract.shot import read_shot, shown

    refuse_missing(out)
    shot = shown(read_shot(out.shot), show)
    parts = read_parts(out.parts, out.name)
    motion = read_any_motion(out.motion, out.name)
    motion = with_rods(motion, parts) if isinstance(motion, Motion) else with_links(motion, parts)
    return Film(motion, parts, shot, out.parts_folder, aspect)
