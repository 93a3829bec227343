"""Warnings that point at the user's line, whichever of our functions finds their reason."""

from __future__ import annotations

import sys
import warnings
from types import FrameType

from mbsd.base.errors import PACKAGE


def warn(message: str, category: type[Warning]) -> None:
    """``warnings.warn`` with the line of the first caller outside this package."""
    if sys.version_info >= (3, 12):
        warnings.warn(message, category, skip_file_prefixes=PACKAGE)
    else:
        warnings.warn(message, category, stacklevel=_depth_of_user(sys._getframe()))


def _depth_of_user(frame: FrameType) -> int:
    """Frames from ``frame`` out to the first one outside this package, ``frame`` counted; the outermost if none is."""
    depth = 1
    while frame.f_code.co_filename.startswith(PACKAGE) and frame.f_back is not None:
        frame, depth = frame.f_back, depth + 1
    return depth
