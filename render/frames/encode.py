"""Encodes pictures as a film: MP4 with H.264, yuv420p and the index in front, for every player and web page."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from render.blender.patience import Patience
from render.frames.film_file import refuse_other_than
from render.presets import Preset
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.files import whole_file
from shared.stage.signals import terminable

SETTINGS = (
    *("-c:v", "libx264", "-preset", "slow", "-crf", "16", "-profile:v", "high"),
    *("-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"),
    *("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"),
    *("-threads", "4", "-movflags", "+faststart", "-map_metadata", "-1"),
    *("-fflags", "+bitexact", "-flags:v", "+bitexact"),
)
TICK = 1.0
"""Seconds by which the patience with ffmpeg is counted."""


def encode(pictures: Iterable[bytes], count: int, preset: Preset, fps: int, film: Path) -> None:
    """Write ``film`` whole from ``count`` PNGs in order, and decode it once to check it.

    Raises UserError if ffmpeg is missing, fails (with its last word) or hangs, or if the film has not each frame.
    """
    command = [ffmpeg(), "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", str(fps), "-c:v", "png"]
    limit = Patience(pictures=1).limit("") * max(1.0, preset.width * preset.height / 1e6)
    with terminable(), whole_file(film) as target, tempfile.TemporaryFile() as chat:
        process = subprocess.Popen(
            [*command, "-i", "-", *SETTINGS, str(target)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=chat,
        )
        with _ended(process), _Watch(process, limit) as watch:
            _feed(process, pictures, watch)
        if watch.fired:
            raise UserError(f"{film.name}: ffmpeg took no picture for {duration(limit)} and was stopped; run it again")
        if process.returncode:
            chat.seek(0)
            words = chat.read().decode(errors="replace").strip().splitlines()
            reason = words[-1] if words and process.returncode > 0 else f"code {process.returncode}"
            raise UserError(f"{film.name}: ffmpeg failed: {reason}{_room(film)}")
        refuse_other_than(target, film.name, ffmpeg(), count, preset, fps, limit)


def _feed(process: subprocess.Popen[bytes], pictures: Iterable[bytes], watch: _Watch) -> None:
    """Hand the pictures over and wait for the end."""
    assert process.stdin is not None
    with suppress(BrokenPipeError):  # ffmpeg gave up; its code and last word tell why
        for picture in pictures:
            process.stdin.write(picture)
            watch.silence = 0.0
        process.stdin.close()
    process.wait()


@contextmanager
def _ended(process: subprocess.Popen[bytes]) -> Iterator[None]:
    """However the block ends, the process has ended after it."""
    try:
        yield
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
        with suppress(BrokenPipeError):
            if process.stdin:
                process.stdin.close()


class _Watch:
    """Kills ffmpeg when it takes nothing for too long. Counted in ticks, so that a stop of our own is no silence."""

    def __init__(self, process: subprocess.Popen[bytes], limit: float) -> None:
        self.process, self.limit = process, limit
        self.silence = 0.0
        self.fired = False
        self._over = threading.Event()

    def __enter__(self) -> _Watch:
        threading.Thread(target=self._run, daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()

    def _run(self) -> None:
        while not self._over.wait(TICK):
            self.silence += TICK
            if self.silence >= self.limit:
                self.fired = True
                self.process.kill()
                return


def _room(film: Path) -> str:
    """How much room the film's disk has, after a semicolon: ffmpeg seldom says that it was full."""
    with suppress(OSError):
        free = shutil.disk_usage(film.parent).free
        return f"; {free / 1e6:.1f} MB are free at {film.parent}"
    return ""


def ffmpeg() -> str:
    """The ffmpeg that imageio-ffmpeg brings, or the system's; raises UserError if there is none."""
    try:
        import imageio_ffmpeg

        return imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        raise UserError(
            "there is no ffmpeg to write the film with; run make install, or install ffmpeg "
            "(sudo apt-get install -y ffmpeg). The frames are kept"
        ) from None
