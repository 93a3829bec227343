"""Gravity points down in every picture of the gallery, or the machine lies on a desk and has none in its plane."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mechanisms.stages.loading.loading import has, load, params
from mechanisms.stages.solve.solving import build
from render.film.camera import angles
from render.film.framing import axes
from shared.contract import mounted
from shared.contract.shot import Shot
from tests.mechanisms.every_folder import folders_and_variants

UPRIGHT = (5.0, 25.0)
"""Elevations (degrees) of the camera at eye level of what stands."""


@pytest.mark.parametrize("name", folders_and_variants())
def test_gravity_is_down_in_the_picture(name: str) -> None:
    m = build(name, load(name, "mechanism"), params(name))
    shot = load(name, "shot").shot if has(name, "shot") else Shot()
    gravity = np.array([*(m.gravity or (0.0, 0.0)), 0.0])
    mount = mounted((gravity[0], gravity[1]), shot.mount)
    azimuth, elevation = angles(shot.camera, mount)
    right, up, forward = axes(azimuth, elevation, mount.up) @ gravity
    if mount.kind == "desk":
        assert not gravity.any(), f"{name} lies on a desk, but gravity is {gravity}"
        return
    assert UPRIGHT[0] <= math.degrees(elevation) <= UPRIGHT[1]
    if gravity.any():
        assert right == pytest.approx(0.0, abs=1e-12)
        assert up < -0.9 * np.linalg.norm(gravity)
        assert abs(forward) < 0.45 * np.linalg.norm(gravity)
