"""The file of a film: it has every frame, in its size and at its time, and each of them decodes."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from render.presets import Preset
from shared.stage.errors import UserError


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
    """Number of frames, their size and the film's seconds in a listing of ffmpeg's framecrc.

    A line for each frame: stream, dts, pts, duration (in units of the time base), size, checksum.
    """
    size = re.search(r"^#dimensions 0: (\d+x\d+)$", listing, flags=re.MULTILINE)
    base = re.search(r"^#tb 0: (\d+)/(\d+)$", listing, flags=re.MULTILINE)
    frames = [line.split(",") for line in listing.splitlines() if line and not line.startswith("#")]
    if not (size and base and frames):
        return 0, "no size", 0.0
    end = int(frames[-1][2]) + int(frames[-1][3])
    return len(frames), size[1], (end - int(frames[0][2])) * int(base[1]) / int(base[2])
