"""The film as a file: encoded from pictures, decoded again, with every frame, or refused."""

from __future__ import annotations

import io
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from render.frames import encode
from render.frames.encode import refuse_other_than
from render.presets import Preset
from shared.stage.errors import UserError

TINY = Preset("tiny", 32, 18, 1)


def test_without_ffmpeg_the_film_says_so(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(UserError, match="no ffmpeg"):
        encode.ffmpeg()


def noise(count: int) -> list[bytes]:
    """PNGs of 32x18."""
    made = []
    for seed in range(count):
        made.append(io.BytesIO())
        pixels = np.random.default_rng(seed).integers(0, 255, (18, 32, 3), dtype=np.uint8)
        Image.fromarray(pixels).save(made[-1], format="PNG")
    return [file.getvalue() for file in made]


def test_ffmpeg_failing_leaves_no_film(tmp_path: Path):
    with pytest.raises(UserError, match=r"film\.mp4: ffmpeg failed: .*MB are free"):
        encode.encode([b"not a picture"], 1, TINY, 30, tmp_path / "film.mp4")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("wanted", [4, 6])
def test_a_film_with_a_frame_too_few_or_too_many_is_refused(tmp_path: Path, wanted: int):
    with pytest.raises(
        UserError, match=rf"the film has 5 frames of 32x18 in 0\.500 s; {wanted} of 32x18 in 0\.{wanted}"
    ):
        encode.encode(noise(5), wanted, TINY, 10, tmp_path / "film.mp4")
    assert not list(tmp_path.iterdir())


def test_a_film_of_another_size_is_refused(tmp_path: Path):
    with pytest.raises(UserError, match=r"the film has 5 frames of 32x18 in .*; 5 of 64x36"):
        encode.encode(noise(5), 5, Preset("other", 64, 36, 1), 10, tmp_path / "film.mp4")


def test_a_film_that_was_cut_does_not_decode(tmp_path: Path):
    film = tmp_path / "film.mp4"
    encode.encode(noise(5), 5, TINY, 10, film)
    content = film.read_bytes()
    refuse_other_than(film, "film", encode.ffmpeg(), 5, TINY, 10, 60.0)
    for cut in (0, 100, len(content) // 2, len(content) - 50):
        film.write_bytes(content[:cut])
        with pytest.raises(UserError, match=r"film: the film (does not decode|has)"):
            refuse_other_than(film, "film", encode.ffmpeg(), 5, TINY, 10, 60.0)


def test_an_ffmpeg_that_hangs_is_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    fake = tmp_path / "ffmpeg"
    fake.write_text("#!/bin/sh\nexec sleep 60\n")
    fake.chmod(0o755)
    monkeypatch.setattr(encode, "ffmpeg", lambda: str(fake))
    monkeypatch.setattr(encode, "TICK", 0.05)
    monkeypatch.setenv("MBSD_PATIENCE", "0.5")
    with pytest.raises(UserError, match=r"film\.mp4: ffmpeg took no picture for 0\.5 s and was stopped"):
        encode.encode(noise(1) * 200, 200, TINY, 10, tmp_path / "film.mp4")
    assert [path.name for path in tmp_path.iterdir()] == ["ffmpeg"]


def test_the_film_is_an_mp4_every_player_takes(tmp_path: Path):
    film = tmp_path / "film.mp4"
    encode.encode(noise(5) * 3, 15, TINY, 10, film)
    content = film.read_bytes()
    assert content.index(b"moov") < content.index(b"mdat")
    said = subprocess.run([encode.ffmpeg(), "-i", str(film)], capture_output=True, text=True, check=False).stderr
    assert "h264 (High)" in said
    assert "yuv420p(tv, bt709" in said
    assert "32x18" in said
    assert "10 fps" in said
    again = tmp_path / "again.mp4"
    encode.encode(noise(5) * 3, 15, TINY, 10, again)
    assert again.read_bytes() == content
