"""A film of a skeleton in motion, on disk."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Animation:
    """A file that was written; a notebook shows it."""

    path: Path
    pictures: int
    """Drawn; an MP4 repeats those of a short round."""
    seconds: float
    """On the screen, once through."""
    rate: float
    """Seconds of the motion in a second on the screen."""

    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> dict[str, object]:
        code = base64.b64encode(self.path.read_bytes()).decode()
        if self.path.suffix.lower() == ".gif":
            return {"text/html": f'<img src="data:image/gif;base64,{code}">'}
        return {"text/html": f'<video controls loop autoplay muted src="data:video/mp4;base64,{code}"></video>'}
