"""At how many parts of a step a function of the user is looked at.

As often as ``shortest`` asks for; else one more value tells whether the polynomial through the first ones knows the
function. If not, intervals whose middle is not what the neighbours let expect are halved. What comes after the first
negative value is not looked at.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mbsd.dynamics.events.bounds import FAR, MOST_VALUES, NARROWEST, PER_SHORTEST, ROUGH, ROUGH_HALVES, TRIED

AT_ONCE = 64


def resolved(
    x: np.ndarray, values: np.ndarray, value: Callable[[np.ndarray], np.ndarray], length: float, shortest: float | None
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Parts (n,) of a step of ``length`` (s) and values there that show how a function goes, and whether they do.

    x (k,), values (k,) are known; ``value`` gives more of them.
    """
    if shortest is not None:
        looks = math.ceil(PER_SHORTEST * length / shortest)
        more = np.setdiff1d(np.linspace(0.0, 1.0, looks + 1), x) if looks >= len(x) else x[:0]
        x, values = _until_negative(x, values)
        for start in range(0, len(more), AT_ONCE):
            part = more[start : start + AT_ONCE]
            part = part[part < x[-1]]
            if not len(part):
                break
            x, values = _until_negative(*_merged(x, values, part, value(part)))
        return x, values, True
    there = value(TRIED)
    expected = np.array([_lagrange(x, at) @ values for at in TRIED])
    spread = float(np.ptp(np.append(values, there)))
    if min(values.min(), there.min()) > FAR * spread or not np.abs(there - expected).max() > ROUGH * spread:
        return x, values, True
    x, values = _until_negative(*_merged(x, values, TRIED, there))
    rough = np.ones(len(x) - 1, bool)
    while rough.any():
        left = np.flatnonzero(rough)
        middles = 0.5 * (x[left] + x[left + 1])
        if len(x) + len(middles) > MOST_VALUES:
            return x, values, False
        there = value(middles)
        near = np.clip(left - 1, 0, len(x) - 4)
        expected = np.array(
            [_lagrange(x[k : k + 4], m) @ values[k : k + 4] for k, m in zip(near, middles, strict=True)]
        )
        missed = np.abs(there - expected) > ROUGH_HALVES * np.ptp(np.append(values, there))
        missed |= np.append(missed[1:], False) | np.append(False, missed[:-1])  # one that agrees may do so by chance
        still = missed & (x[left + 1] - x[left] > NARROWEST)
        halves = np.concatenate([x[left[still]], middles[still]])
        x, values = _until_negative(*_merged(x, values, middles, there))
        rough = np.isin(x[:-1], halves)
    return x, values, True


def _until_negative(x: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    below = np.flatnonzero(values[1:] < 0.0)
    end = int(below[0]) + 2 if len(below) else len(x)
    return x[:end], values[:end]


def _merged(x: np.ndarray, values: np.ndarray, more: np.ndarray, there: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    x, values = np.append(x, more), np.append(values, there)
    order = np.argsort(x, kind="stable")
    return x[order], values[order]


def _lagrange(x: np.ndarray, at: float) -> np.ndarray:
    """(n,) weights of values at x (n,) in the polynomial through them."""
    away = x[:, None] - x + np.eye(len(x))
    return np.array([np.prod(np.delete(at - x, k)) / np.prod(away[k]) for k in range(len(x))])
