"""Encoders of pictures: MP4 by ffmpeg, which any player shows, and GIF by Pillow.

Files are written whole.
"""

from __future__ import annotations

import io
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.files import temporary_file, whole_file, write_whole
from mbsd.drawing.animation.words import CARD, KINETIC, POTENTIAL, QUANTITIES, TAKEN
from mbsd.drawing.look import INK, PAPER, QUIET

PLAIN = ("-movflags", "+faststart", "-map_metadata", "-1", "-fflags", "+bitexact")
H264 = (
    *("-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-profile:v", "high", "-bf", "0"),
    *("-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"),
    *("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"),
    *("-threads", "2", "-flags:v", "+bitexact"),
    *PLAIN,
)
EXACT = (PAPER, CARD, INK, QUIET, KINETIC, POTENTIAL, TAKEN, *(quantity.colour for quantity in QUANTITIES.values()))
"""Colours that a GIF must not change."""
SAMPLED = 6
"""Pictures from which the colours of a GIF are taken."""


def ffmpeg() -> str:
    """Return the program that imageio-ffmpeg brings, or the system's. Raises ModelError if there is none."""
    try:
        import imageio_ffmpeg

        return imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        path = shutil.which("ffmpeg")
        if path is None:
            raise ModelError(
                "an MP4 needs ffmpeg: install mbsd[animate], or ffmpeg itself; a path that ends with .gif needs neither"
            ) from None
        return path


def write_mp4(path: Path, pictures: Iterable[np.ndarray], size: tuple[int, int], fps: float, rounds: int) -> None:
    """Write (H, W, 4) bytes of each picture, all of them ``rounds`` times over, encoded once.

    Raises ModelError where ffmpeg fails or the file cannot be written.
    """
    program = [ffmpeg(), "-y", "-loglevel", "error"]
    raw = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{size[0]}x{size[1]}", "-framerate", f"{fps:.6g}", "-i", "-"]
    with whole_file(path) as target:
        if rounds == 1:
            _run(path, [*program, *raw, *H264, str(target)], pictures)
            return
        with temporary_file(path) as once:
            _run(path, [*program, *raw, *H264, str(once)], pictures)
            again = ["-stream_loop", str(rounds - 1), "-i", str(once), "-c", "copy"]
            _run(path, [*program, *again, *PLAIN, str(target)], ())


def _run(path: Path, command: list[str], pictures: Iterable[np.ndarray]) -> None:
    with tempfile.TemporaryFile() as chat:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=chat)
        try:
            assert process.stdin is not None
            with suppress(BrokenPipeError):  # its last word is the reason
                for picture in pictures:
                    process.stdin.write(np.ascontiguousarray(picture))
                process.stdin.close()
            process.wait()
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
        if process.returncode:
            chat.seek(0)
            said = chat.read().decode(errors="replace").strip().splitlines() or [f"code {process.returncode}"]
            raise ModelError(f"cannot write {path}: ffmpeg failed: {said[-1]}")


def write_gif(path: Path, pictures: Iterable[np.ndarray], count: int, fps: float, hold: float) -> None:
    """Write (H, W, 4) bytes of ``count`` pictures as a GIF that repeats for ever.

    ``hold``: seconds more for the last one.
    """
    from PIL import Image

    kept = [Image.fromarray(np.ascontiguousarray(picture[..., :3])) for picture in pictures]
    some = kept[:: max(1, count // SAMPLED)]
    strip = Image.new("RGB", (some[0].width, some[0].height * len(some)))
    for k, picture in enumerate(some):
        strip.paste(picture, (0, k * picture.height))
    palette = _palette(strip)
    drawn = [_indexed(picture, palette) for picture in kept]
    each = round(100.0 / fps) * 10
    times = [each] * len(drawn)
    times[-1] += round(hold * 100) * 10
    buffer = io.BytesIO()
    drawn[0].save(
        buffer, format="GIF", save_all=True, append_images=drawn[1:], duration=times, loop=0, optimize=False, disposal=1
    )
    write_whole(path, buffer.getvalue())


def _palette(strip: Any) -> Any:
    """Return the colours that mean something as they are, and the others of ``strip`` that are met most."""
    from PIL import Image

    plain = [int(colour[k : k + 2], 16) for colour in EXACT for k in (1, 3, 5)]
    quantized = strip.quantize(256 - len(EXACT), method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    out = Image.new("P", (1, 1))
    out.putpalette((plain + (quantized.getpalette() or []))[:768])
    return out


def _indexed(picture: Any, palette: Any) -> Any:
    """Return the picture by numbers of ``palette``.

    Pillow seeks near colours in steps of four; those of :data:`EXACT` are corrected.
    """
    from PIL import Image

    indexed = picture.quantize(palette=palette, dither=Image.Dither.NONE)
    red, green, blue = np.moveaxis(np.asarray(picture, np.uint32), -1, 0)
    whole, numbers = red << 16 | green << 8 | blue, np.array(indexed)
    for number, colour in enumerate(EXACT):
        numbers[whole == int(colour[1:], 16)] = number
    out = Image.fromarray(numbers)
    out.putpalette(indexed.getpalette())
    return out


def held(pictures: Iterable[np.ndarray], still: int) -> Iterator[np.ndarray]:
    """Yield all pictures, and the last one ``still`` times more."""
    picture = np.zeros(0)
    for picture in pictures:
        yield picture
    for _ in range(still):
        yield picture
