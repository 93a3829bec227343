"""Encoding of films by ffmpeg: frames, sound, and files that arrive whole."""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from render.blender.process import Patience
from render.presets import Preset
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.files import whole_file
from shared.stage.signals import terminable

# The file of a film: it has every frame, in its size and at its time, and each of them decodes.


def refuse_other_than(
    film: Path, name: str, ffmpeg: str, count: int, preset: Preset, fps: int, patience: float
) -> None:
    """Decode a film from its first frame to its last; raises UserError if it is not what it should be.

    ``name`` is what messages call it; ``patience`` bounds the seconds that ffmpeg may take for a hundred frames.
    """
    command = [ffmpeg, "-v", "error", "-xerror", "-i", str(film), "-map", "0:v:0", "-f", "framecrc", "-"]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, errors="replace", timeout=patience * (1 + count / 100)
        )
    except subprocess.TimeoutExpired as error:
        raise UserError(
            f"{name}: ffmpeg did not read the film back within {error.timeout:.0f} s; run it again"
        ) from None
    said = done.stderr.strip().splitlines()
    if done.returncode or said:
        reason = said[-1] if said else f"code {done.returncode}"
        raise UserError(f"{name}: the film does not decode ({reason}); is the disk full? Run the same command again")
    wanted = (count, f"{preset.width}x{preset.height}", count / fps)
    measured = _measured(done.stdout)
    if measured[:2] != wanted[:2] or abs(measured[2] - wanted[2]) > 1e-6 + 0.1 / fps:
        raise UserError(
            f"{name}: the film has {measured[0]} frames of {measured[1]} in {measured[2]:.3f} s; {wanted[0]} of "
            f"{wanted[1]} in {wanted[2]:.3f} s went in. Is the disk full? Run the same command again"
        )


def _measured(listing: str) -> tuple[int, str, float]:
    """Return the number of frames, their size and the film's seconds in a listing of ffmpeg's framecrc.

    A line for each frame: stream, dts, pts, duration (in units of the time base), size, checksum.
    """
    size = re.search(r"^#dimensions 0: (\d+x\d+)$", listing, flags=re.MULTILINE)
    base = re.search(r"^#tb 0: (\d+)/(\d+)$", listing, flags=re.MULTILINE)
    frames = [line.split(",") for line in listing.splitlines() if line and not line.startswith("#")]
    if not (size and base and frames):
        return 0, "no size", 0.0
    end = int(frames[-1][2]) + int(frames[-1][3])
    return len(frames), size[1], (end - int(frames[0][2])) * int(base[1]) / int(base[2])


# Encodes pictures as a film: MP4 with H.264, yuv420p and the index in front, for every player and web page.

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
    """End the process after the block, however that ends."""
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
    """Return how much room the film's disk has, after a semicolon: ffmpeg seldom says that it was full."""
    with suppress(OSError):
        free = shutil.disk_usage(film.parent).free
        return f"; {free / 1e6:.1f} MB are free at {film.parent}"
    return ""


def ffmpeg() -> str:
    """Return the ffmpeg that imageio-ffmpeg brings, or the system's; raises UserError if there is none."""
    try:
        import imageio_ffmpeg

        return imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        raise UserError(
            "there is no ffmpeg to write the film with; run make install, or install ffmpeg "
            "(sudo apt-get install -y ffmpeg). The frames are kept"
        ) from None


# A run of ffmpeg to its end, with its last word in the error.


def run_ffmpeg(name: str, *arguments: str, patience: float) -> None:
    """Run ffmpeg for the file ``name``. Raises UserError where it fails or takes longer than ``patience`` (s)."""
    command = [ffmpeg(), "-y", "-v", "error", *arguments]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=patience)
    except subprocess.TimeoutExpired:
        raise UserError(f"{name}: ffmpeg took longer than {patience:.0f} s; run it again") from None
    if done.returncode:
        said = (done.stderr.strip().splitlines() or [f"code {done.returncode}"])[-1]
        raise UserError(f"{name}: ffmpeg failed: {said}")


# Pictures and sound as one file: the pictures' packets as they are, the sound as AAC, and the same bytes each time.

AAC = ("-c:a", "aac", "-b:a", "192k", "-ar", "48000", "-ac", "2", "-flags:a", "+bitexact")
SOUND_SETTINGS = (
    *("-map", "0:v:0", "-map", "1:a:0", "-c:v", "copy"),
    *AAC,
    *("-movflags", "+faststart", "-map_metadata", "0", "-map_chapters", "0", "-fflags", "+bitexact"),
)


def mux(pictures: Path, sound: Path, count: int, preset: Preset, fps: int, film: Path) -> None:
    """Write ``film`` whole from the silent film ``pictures`` and a WAV file of the same length.

    Raises UserError if ffmpeg is missing, fails or hangs, or if the film has not each of ``count`` frames.
    """
    limit = Patience(pictures=1).limit("") * max(1.0, preset.width * preset.height / 1e6) * (1 + count / 100)
    with terminable(), whole_file(film) as target:
        command = [
            ffmpeg(),
            "-y",
            "-loglevel",
            "error",
            "-i",
            str(pictures),
            "-i",
            str(sound),
            *SOUND_SETTINGS,
            str(target),
        ]
        try:
            done = subprocess.run(
                command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", timeout=limit
            )
        except subprocess.TimeoutExpired:
            raise UserError(
                f"{film.name}: ffmpeg was stopped after {duration(limit)}, pictures and sound not joined; run it again"
            ) from None
        if done.returncode:
            said = (done.stderr.strip().splitlines() or [f"code {done.returncode}"])[-1]
            raise UserError(f"{film.name}: ffmpeg could not join pictures and sound: {said}; SOUND=off films without")
        refuse_other_than(target, film.name, ffmpeg(), count, preset, fps, limit)
