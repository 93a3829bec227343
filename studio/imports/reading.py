"""Which program a file is of, by what is in it, and the mechanism that it holds."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from shared.stage.errors import UserError
from studio.imports import asmt, dxf, linkage, mbsd_core, pmks_text, pmks_url, pylinkage
from studio.imports.sketch import Sketch

FORMATS: dict[str, tuple[Callable[[str], bool], Callable[[str, str], Sketch]]] = {
    "PMKS+ (its address)": (pmks_url.is_pmks_url, pmks_url.read),
    "Linkage (.linkage2)": (linkage.is_linkage, linkage.read),
    "Ondsel and FreeCAD (.asmt)": (asmt.is_asmt, asmt.read),
    "a sketch (DXF)": (dxf.is_dxf, dxf.read),
    "PMKS (.txt, .pmks)": (pmks_text.is_pmks, pmks_text.read),
    "mbsd-core (JSON)": (mbsd_core.is_mbsd_core, mbsd_core.read),
    "pylinkage (JSON)": (pylinkage.is_pylinkage, pylinkage.read),
}
LARGEST = 1 << 26
"""Bytes"""


def read(source: str) -> Sketch:
    """The mechanism of a file, or of an address of PMKS+. Raises UserError for what is neither, or cannot be read."""
    file = Path(source)
    if "://" in source or pmks_url.is_pmks_url(source):
        name, text = "address", source
    else:
        name, text = file.name, _text(file)
    for is_one, reader in FORMATS.values():
        if is_one(text):
            sketch = reader(text, name)
            if not sketch.links:
                raise UserError(f"{name}: nothing in it moves")
            return sketch
    raise UserError(f"{name} is of no program that is known here; known are: {', '.join(FORMATS)}")


def _text(file: Path) -> str:
    try:
        if file.stat().st_size > LARGEST:
            raise UserError(f"{file} is larger than {LARGEST >> 20} MB; that is no mechanism")
        content = file.read_bytes()
    except OSError as error:
        raise UserError(f"{file} cannot be read: {error.strerror}") from error
    if b"\0" in content:
        raise UserError(f"{file} is no text")
    for encoding in ("utf-8-sig", "cp1252", "latin-1"):
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    raise UserError(f"{file} is no text")
