"""A finished film as the showreel takes it: its packets and the parameters that its neighbours must share."""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from render.frames.encode import ffmpeg
from shared.stage.errors import UserError

PATIENCE = 600.0
"""Seconds in which ffmpeg has to read a film."""


@dataclass(frozen=True)
class Parameters:
    """What players take from the first film of a joined file and use for all."""

    codec: str
    size: str
    tick: str
    """Seconds of a tick of its times, as a fraction."""
    header: str
    """SHA-256 of the codec's own parameters: profile, level, colours, reference frames."""


@dataclass(frozen=True)
class Clip:
    """One film."""

    path: Path
    parameters: Parameters
    frames: int
    fps: int
    packets: tuple[str, ...]
    """SHA-256 of each compressed frame, in the order of the file."""


def read_clip(path: Path) -> Clip:
    """Read a film without decoding it. Raises UserError if it is not one."""
    command = [ffmpeg(), "-v", "error", "-i", str(path)]
    command += ["-map", "0:v:0", "-c", "copy", "-f", "framehash", "-hash", "sha256", "-"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        raise UserError(f"{path}: ffmpeg did not read it within {PATIENCE:.0f} s; run it again") from None
    words = dict(re.findall(r"^#(tb|codec_id|dimensions) 0: (\S+)$", done.stdout, re.MULTILINE))
    header = re.search(r"^#extradata 0,\s*\d+,\s*(\w+)$", done.stdout, re.MULTILINE)
    rows = [re.split(r",\s*", line) for line in done.stdout.splitlines() if line and not line.startswith("#")]
    if done.returncode or not rows or len(words) < 3 or not header:
        said = (done.stderr.strip().splitlines() or ["it has no pictures"])[-1]
        raise UserError(f"{path} is not a film ({said}); remove it and make it again")
    rate = 1 / (Fraction(words["tb"]) * max(1, int(rows[0][3])))
    return Clip(
        path=path,
        parameters=Parameters(words["codec_id"], words["dimensions"], words["tb"], header[1]),
        frames=len(rows),
        fps=max(1, round(rate)),
        packets=tuple(row[-1] for row in rows),
    )
