"""What is written beside a picture goes; the picture and its colours stay."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, PngImagePlugin

from render.blender.picture_file import make_plain, without_notes


def picture(words: str, seed: int = 0) -> bytes:
    notes = PngImagePlugin.PngInfo()
    notes.add_text("Date", words)
    notes.add_text("RenderTime", words, zip=True)
    notes.add(b"gAMA", (45455).to_bytes(4))
    pixels = np.random.default_rng(seed).integers(0, 256, (7, 5, 3), dtype=np.uint8)
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, format="PNG", pnginfo=notes, exif=b"Exif\0\0" + words.encode(), dpi=(72, 72))
    return buffer.getvalue()


def test_notes_go_and_the_picture_stays() -> None:
    content = picture("2026/11/22")
    plain = without_notes(content)
    assert not [word for word in (b"2026", b"Date", b"pHYs", b"eXIf") if word in plain]
    assert b"gAMA" in plain
    assert plain.endswith(b"IEND\xaeB`\x82")
    with Image.open(io.BytesIO(content)) as before, Image.open(io.BytesIO(plain)) as after:
        assert np.array_equal(np.asarray(before), np.asarray(after))
    assert without_notes(picture("10:00")) == plain
    assert without_notes(picture("10:00", seed=1)) != plain
    assert without_notes(plain) == plain


@given(st.data())
def test_a_cut_file_is_left_alone(data: st.DataObject) -> None:
    content = picture("now")
    cut = content[: data.draw(st.integers(0, len(content) - 1))]
    assert without_notes(cut) == cut or cut.endswith(b"IEND\xaeB`\x82") or _on_a_border(cut)
    assert without_notes(b"GIF89a" + cut) == b"GIF89a" + cut


def _on_a_border(cut: bytes) -> bool:
    """Whether the cut is between two chunks: what is left has no end, which the check of a picture finds."""
    place = 8
    while place < len(cut):
        place += 12 + int.from_bytes(cut[place : place + 4])
    return place == len(cut) and not without_notes(cut).endswith(b"IEND\xaeB`\x82")


def test_a_file_is_written_anew_only_where_something_goes(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(picture("x"))
    make_plain(path)
    before = path.stat().st_mtime_ns, path.read_bytes()
    make_plain(path)
    assert (path.stat().st_mtime_ns, path.read_bytes()) == before
