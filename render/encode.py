"""Pictures to a film: MP4 with H.264, yuv420p and the index in front, so that every player and web page shows it."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

from shared.errors import UserError
from shared.files import whole_file
from shared.signals import terminable

SETTINGS = (
    *("-c:v", "libx264", "-preset", "slow", "-crf", "16", "-profile:v", "high"),
    *("-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"),
    *("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"),
    *("-threads", "4", "-movflags", "+faststart", "-map_metadata", "-1"),
    *("-fflags", "+bitexact", "-flags:v", "+bitexact"),
)


def encode(pictures: Sequence[Path], fps: int, film: Path) -> None:
    """Write ``film`` whole from PNGs in order. Raises UserError if ffmpeg is missing or fails, with its last word."""
    command = [ffmpeg(), "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", str(fps), "-c:v", "png"]
    with terminable(), whole_file(film) as target:
        process = subprocess.Popen(
            [*command, "-i", "-", *SETTINGS, str(target)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )
        assert process.stdin is not None
        try:
            for picture in pictures:
                process.stdin.write(picture.read_bytes())
        except BrokenPipeError:
            pass  # ffmpeg gave up; its reason follows
        except BaseException:
            process.kill()
            process.wait()
            raise
        _, said = process.communicate()
        if process.returncode:
            words = said.decode(errors="replace").strip().splitlines()
            raise UserError(f"{film.name}: ffmpeg failed: {words[-1] if words else f'code {process.returncode}'}")


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
