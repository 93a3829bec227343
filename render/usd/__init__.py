"""OpenUSD: ``python -m render usd NAME`` writes the scene of the GLB as .usdc, or .usdz.

Quick Look reads .usdz.
"""

from __future__ import annotations

import io
import struct
import tempfile
import zipfile
from pathlib import Path
from typing import Any

from render.film.inputs import read_film
from render.glb import glb_key
from shared.stage.console import say
from shared.stage.errors import UserError, did_you_mean
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of

FORMATS = {"usd": ".usdc", "usdz": ".usdz"}
"""Endings of the file by name."""
FIRST_TIME = struct.pack("<HH", 0, 0x21)
"""Midnight, and 1 January 1980, as ZIP has them."""


def run(name: str, form: str = "usd") -> None:
    """Write out/<name>/export/<name>.usdc, or .usdz.

    Raises UserError if motion, parts, shot or OpenUSD are missing, and for a format that is neither.
    """
    if form not in FORMATS:
        raise UserError(
            f"there is no format {form!r}; choose one of: {', '.join(FORMATS)}{did_you_mean(form, FORMATS)}"
        )
    out = Out(name)
    _refuse_without_usd(out.name)
    from render.glb.cut import said_of
    from render.usd.scene import stage_of

    film = read_film(out)
    stage = _stage(out, form)
    path = stage.outputs[0]
    write_bytes(path, content(stage_of(film), out.name, form))
    stage.record()
    if said := said_of(film):
        say("export", said)
    seconds = film.motion.time[-1] - film.motion.time[0]
    say("export", f"{out.name}: {path}: {seconds:.4g} s, {path.stat().st_size / 1e6:.1f} MB")


def is_fresh(name: str, form: str) -> bool:
    """Return True if the file that is there is of the motion, the parts and the shot that are there."""
    return _stage(Out(name), form).is_fresh()


def _stage(out: Out, form: str) -> Stage:
    key = key_of(glb_key(out), form, sources_hash(Path(__file__).parent))
    return Stage(out, f"export-{form}", key, [out.folder / "export" / f"{out.name}{FORMATS[form]}"])


def content(stage: Any, name: str, form: str) -> bytes:
    """Return the bytes of a stage's file."""
    from pxr import Sdf, UsdUtils

    with tempfile.TemporaryDirectory() as folder:
        layer, packed = (Path(folder) / f"{name}{ending}" for ending in FORMATS.values())
        stage.Export(str(layer), addSourceFileComment=False)
        if form == "usdz":
            UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(layer)), str(packed))
            return without_times(packed.read_bytes())
        return layer.read_bytes()


def without_times(archive: bytes) -> bytes:
    """Return a ZIP archive with all times set to the first that the format knows, 1 January 1980.

    They stand in the header of each file (bytes 10 to 13) and in the central directory (12 to 15).
    """
    content = bytearray(archive)
    with zipfile.ZipFile(io.BytesIO(archive)) as packed:
        place, files = packed.start_dir, packed.infolist()
    for file in files:
        content[file.header_offset + 10 : file.header_offset + 14] = FIRST_TIME
        content[place + 12 : place + 16] = FIRST_TIME
        lengths = struct.unpack("<3H", content[place + 28 : place + 34])  # of name, extra field and comment
        place += 46 + sum(lengths)
    return bytes(content)


def _refuse_without_usd(name: str) -> None:
    try:
        import pxr  # noqa: F401
    except ImportError:
        raise UserError(
            f"{name}: OpenUSD is not installed; run: pip install 'mbsd[usd]', or pip install usd-core"
        ) from None
