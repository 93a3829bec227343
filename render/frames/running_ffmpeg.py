"""A run of ffmpeg to its end, with its last word in the error."""

from __future__ import annotations

import subprocess

from render.frames.encode import ffmpeg
from shared.stage.errors import UserError


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
