"""A machine that goes away is followed: the way of a damped camera over the whole film, known before the first frame.

The way is the middle of the machine, frame after frame, averaged with the weights of a bell as wide as :data:`DAMPED`.
It lags behind nothing, since it knows what comes; it starts and stops softly, and closes where the film does.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
DAMPED = 0.45
"""Standard deviation of the bell, in seconds of film."""
AWAY = 0.5
"""A machine travels if its places at two times are so many of its own lengths apart, at the least, ..."""
GONE = 0.6
"""... and if at the end it is so far from where it began, as a part of the length of the box around its way."""
WIDEST = 0.9
"""What is followed is framed by less than this part of what it sweeps, else the camera may as well stand."""


def travels(places: Array, repeats: bool) -> bool:
    """Whether a machine with points (T, n, 3) at equal steps of the film goes away from where it is, for good.

    A pendulum swings about a place that it always covers, a planet comes back, and so does what ``repeats``.
    """
    if repeats or len(places) < 2:
        return False
    low, high = places.min(axis=1), places.max(axis=1)
    middles = (low + high) / 2
    apart = low.max(axis=0) - high.min(axis=0)
    longest = float((high - low).max())
    sweep = float(np.ptp(middles, axis=0).max())
    gone = float(np.abs(middles[-1] - middles[0]).max())
    return bool(apart.max() > AWAY * longest) and gone > GONE * sweep


def way(places: Array, frames: int, fps: float, repeats: bool) -> Array:
    """The way (frames, 3) of the camera's target past a machine with points (T, n, 3) in the first T frames; it stands
    at its last place in the others.
    """
    middles = (places.min(axis=1) + places.max(axis=1)) / 2
    middles = np.concatenate([middles, np.repeat(middles[-1:], max(0, frames - len(middles)), axis=0)])[:frames]
    return damped(middles, DAMPED * fps, repeats)


def damped(values: Array, width: float, repeats: bool) -> Array:
    """Series (T, k) averaged with a bell of that standard deviation, in steps; held at its ends, or closed."""
    reach = max(1, int(np.ceil(3.5 * width)))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    weights /= weights.sum()
    count = len(values)
    at = np.arange(count)[:, None] + np.arange(-reach, reach + 1)
    at = at % count if repeats else np.clip(at, 0, count - 1)
    return np.einsum("tjk,j->tk", values[at], weights)
