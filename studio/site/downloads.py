"""Files of a mechanism that its page offers: copies, and folders as one reproducible ZIP."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from shared.stage.files import write_bytes
from shared.stage.paths import Out, mechanism_file

LARGEST = 40_000_000
"""Bytes of a download; what is larger stays at home."""
EPOCH = 1980, 1, 1, 0, 0, 0


@dataclass(frozen=True)
class Download:
    """File beside the page, and its description."""

    file: str
    words: str
    size: int


def write_downloads(name: str, folder: Path, is_of_now: Callable[[Path], bool]) -> list[Download]:
    """Copy current files of a mechanism into ``folder``; outdated ones are removed."""
    out, written = Out(name), []
    for file, words, content in _offered(out, mechanism_file(name), is_of_now):
        if len(content) > LARGEST:
            continue
        path = folder / file
        if not path.is_file() or path.read_bytes() != content:
            write_bytes(path, content)
        written.append(Download(file, words, len(content)))
    for older in set(folder.glob("*")) - {folder / each.file for each in written}:
        older.unlink()
    return written


def _offered(out: Out, source: Path, is_of_now: Callable[[Path], bool]) -> Iterator[tuple[str, str, bytes]]:
    yield source.name, "the model, Python", source.read_bytes()
    singles = (
        (out.motion, "the motion, JSON"),
        (out.glb, "parts in motion, glTF"),
        (out.report, "the report"),
    )
    for path, words in singles:
        if path.is_file() and is_of_now(path):
            yield path.name, words, path.read_bytes()
    folders = (
        (out.parts_folder, "*.stl", f"{out.name}_stl.zip", "parts, STL"),
        (out.parts_folder, "*.step", f"{out.name}_step.zip", "parts, STEP"),
        (out.print_folder, "*.3mf", f"{out.name}_3mf.zip", "plates to print, 3MF"),
        (out.print_folder, "*.dxf", f"{out.name}_dxf.zip", "outlines to cut, DXF"),
    )
    for folder, pattern, file, words in folders:
        if (paths := sorted(folder.glob(pattern))) and all(map(is_of_now, paths)):
            yield file, words, _zipped(paths)


def _zipped(paths: list[Path]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path in paths:
            entry = zipfile.ZipInfo(path.name, EPOCH)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, path.read_bytes())
    return buffer.getvalue()
