"""Where a joint must be in a picture of the page, and where the dot in what is selected is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import uniform_filter

from render.film.framing import SENSOR, axes
from render.film.inputs import read_film
from render.film.poses import Moment
from render.presets import ASPECT
from shared.stage.paths import Out

ACCENT = (255, 138, 76)
"""Colour of the dot in the dark theme."""
REACH = 5
"""Its radius (pixels)."""


def projected(out: Out, joint: str, place: tuple[float, float], stage: dict[str, float]) -> tuple[float, float]:
    """Pixels in the stage of a joint's label place (m), by the film's camera."""
    film = read_film(out)
    pose = film.overview
    z = film.heights.label(joint, Moment(0.0, 0))[2]
    u, v, w = axes(pose.azimuth, pose.elevation, pose.up) @ (np.array([*place, z]) - np.array(pose.position))
    aspect = stage["width"] / stage["height"]
    scale = stage["height"] * min(aspect, ASPECT) / (SENSOR / pose.lens)
    return stage["width"] / 2 + scale * u / w, stage["height"] / 2 - scale * v / w


def dot(picture: Path) -> tuple[float, float]:
    """Middle of the dot in what is selected: the place with the most pixels of its colour around it."""
    pixels = np.asarray(Image.open(picture).convert("RGB")).astype(int)
    there = (np.abs(pixels - ACCENT).max(axis=2) < 3).astype(float)
    around = uniform_filter(there, 2 * REACH + 1, mode="constant")
    row, column = np.unravel_index(int(around.argmax()), around.shape)
    rows, columns = np.nonzero(there[row - REACH : row + REACH + 1, column - REACH : column + REACH + 1])
    assert len(rows) > 30, picture
    return float(column - REACH + columns.mean() + 0.5), float(row - REACH + rows.mean() + 0.5)
