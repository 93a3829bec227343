"""Files of pictures: whole, of the size that was ordered, plain, under their own names."""

from __future__ import annotations

import io
import math
import zlib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, PngImagePlugin

from mbsd.dealing.report import WrongAnswer
from render.blender.picture_file import SIGNATURE, fault_of, make_plain, most_bytes, name_of, without_notes
from render.blender.worker.picture import save_whole
from render.frames import cluster
from render.frames.cluster import Made
from render.frames.store import FrameStore
from shared.stage.errors import UserError

WIDTH, HEIGHT = 48, 27
KEY = "0123456789abcdef" * 2


def png(width: int = WIDTH, height: int = HEIGHT, mode: str = "RGB", kind: str = "PNG", **more: Any) -> bytes:
    content = io.BytesIO()
    noise = Image.effect_noise((width, height), 80.0).convert(mode)
    noise.save(content, kind, **more)
    return without_notes(content.getvalue())


def chunk(kind: bytes, data: bytes) -> bytes:
    return len(data).to_bytes(4) + kind + data + zlib.crc32(kind + data).to_bytes(4)


def with_rows(rows: bytes, width: int = WIDTH, height: int = HEIGHT) -> bytes:
    """A PNG whose checksums are right, whatever its rows are."""
    header = width.to_bytes(4) + height.to_bytes(4) + b"\x08\x02\x00\x00\x00"
    return SIGNATURE + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


WHOLE = png()
ROWS = bytes((3 * WIDTH + 1) * HEIGHT)
RUBBISH = {
    "nothing": b"",
    "text": b"this is no picture",
    "cut short": WHOLE[: len(WHOLE) // 2],
    "cut in its rows, with an end": WHOLE[: len(WHOLE) // 2] + WHOLE[-12:],
    "the last byte is missing": WHOLE[:-1],
    "more after its end": WHOLE + b"more",
    "two pictures": WHOLE + WHOLE,
    "another size": png(8, 8),
    "height and width exchanged": png(HEIGHT, WIDTH),
    "a size that no memory holds": with_rows(ROWS, 2**31 - 1, 2**31 - 1),
    "another kind of file": png(kind="JPEG"),
    "grey": png(mode="L"),
    "with an alpha": png(mode="RGBA"),
    "a palette": png(mode="P"),
    "with a text": WHOLE[:33] + chunk(b"tEXt", b"Date\x00now") + WHOLE[33:],
    "a wrong checksum": WHOLE[:60] + bytes([WHOLE[60] ^ 1]) + WHOLE[61:],
    "half of its rows": with_rows(ROWS[: len(ROWS) // 2]),
    "a row more": with_rows(ROWS + bytes(3 * WIDTH + 1)),
    "a filter that is none": with_rows(b"\x09" * len(ROWS)),
    "rows without end": with_rows(bytes(10_000_000)),
    "far too large": SIGNATURE + bytes(10_000_000),
}


def reader() -> Any:
    job = SimpleNamespace(width=WIDTH, height=HEIGHT, pictures=[SimpleNamespace(key=KEY, name="frame 3")])
    return cluster.reader(job)  # pyright: ignore[reportArgumentType]


def sent(content: bytes, name: str = "", cycles: float = 0.5, device: str = "CPU") -> bytes:
    return msgspec.msgpack.encode(Made(name or name_of(KEY, content), content, cycles, device))


@pytest.mark.parametrize("picture", [WHOLE, with_rows(ROWS), png(compress_level=0)])
def test_whole_pictures_are_taken(picture: bytes) -> None:
    assert fault_of(picture, WIDTH, HEIGHT) is None
    assert len(picture) <= most_bytes(WIDTH, HEIGHT)
    made = reader()(KEY, sent(picture, device="a\x1b[2J GPU"))
    assert (made.content, made.device) == (picture, "a [2J GPU")


@pytest.mark.parametrize("kind", RUBBISH)
def test_rubbish_under_its_right_name_is_refused(kind: str) -> None:
    with pytest.raises(WrongAnswer, match="frame 3 "):
        reader()(KEY, sent(RUBBISH[kind]))


@pytest.mark.parametrize(
    "answer",
    [
        sent(WHOLE, name=f"../../{name_of(KEY, WHOLE)}"),
        sent(WHOLE, name=f"/tmp/{name_of(KEY, WHOLE)}"),
        sent(WHOLE, name=name_of("another", WHOLE)),
        sent(WHOLE, name=name_of(KEY, WHOLE[:-1])),
        sent(WHOLE, cycles=math.nan),
        sent(WHOLE, cycles=-1.0),
        sent(WHOLE, cycles=math.inf),
        sent(WHOLE)[:-1],
        msgspec.msgpack.encode(None),
        msgspec.msgpack.encode([1, 2]),
        msgspec.msgpack.encode({"name": "x", "content": b"", "cycles": 0.0, "device": 3}),
        b"",
    ],
)
def test_what_is_not_as_ordered_is_refused(answer: bytes) -> None:
    with pytest.raises(WrongAnswer, match="frame 3 "):
        reader()(KEY, answer)


@pytest.mark.parametrize("kind", ["text", "cut short", "another size"])
def test_rubbish_that_is_in_the_folder_already_is_missed(kind: str, tmp_path: Path) -> None:
    """The same command makes it again, where it said that there was nothing to do."""
    content, size = RUBBISH[kind], (WIDTH, HEIGHT)
    name = name_of(KEY, content)
    FrameStore(tmp_path).keep(name, content)
    assert FrameStore(tmp_path, size).read(name) is None
    assert FrameStore(tmp_path, size).find(KEY) is None
    assert not (tmp_path / name).exists()
    with pytest.raises(UserError, match="came damaged"):
        FrameStore(tmp_path, size).keep(name, content)


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


def whole(path: Path) -> str | None:
    """The check of a file that must hold ``whole``."""
    return None if path.exists() and path.read_bytes() == b"whole" else "is cut short"


def test_an_error_of_blender_is_tried_again_and_then_told(tmp_path: Path) -> None:
    part, calls = tmp_path / "part", []

    def fails(path: Path) -> None:
        calls.append(path)
        raise RuntimeError("Error: No space left on device\n")

    with pytest.raises(UserError, match=r"the file that Blender saved was not written \(Error: No space left"):
        save_whole(part, fails, whole, 1000, "scene.blend")
    assert len(calls) == 2
    assert list(tmp_path.iterdir()) == []


def test_a_second_attempt_may_succeed(tmp_path: Path) -> None:
    part, calls = tmp_path / "part", []

    def at_last(path: Path) -> None:
        calls.append(path)
        if len(calls) == 1:
            raise RuntimeError("Error: device busy")
        path.write_bytes(b"whole")

    save_whole(part, at_last, whole, 1000, "scene.blend")
    assert part.read_bytes() == b"whole"
