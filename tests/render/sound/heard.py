"""Films without solids and pictures, for what is heard of a motion, and what ffmpeg measures of it."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from mbsd import Mechanism, Solution, constant_rate
from mechanisms.stages.solve.motion_file import to_motion
from render.film.clock import Clock
from render.film.poses import Poses
from render.frames.encode import ffmpeg
from render.sound.mix import energies
from shared.contract import BodyParts, Mass, Motion, Mount, Piece
from shared.contract.shot import Shot

SIZE = 0.2
"""Size of every machine here (m)."""


def bar(length: float = 0.12, width: float = 0.016, height: float = 0.008, material: str = "steel") -> BodyParts:
    """A plain bar."""
    volume = length * width * height
    mass = 7850 * volume
    inertia = mass * (length**2 + width**2) / 12
    properties = Mass(mass=mass, com=(0.0, 0.0), inertia=inertia, volume=volume)
    piece = Piece(
        material=material, stl="bar.stl", step="bar.step", mass=properties, z_range=(0.0, height), triangles=12,
        stl_sha256="0" * 64,
    )  # fmt: skip
    return BodyParts(pieces={"bar": piece}, mass=properties, z=0.0)


def filmed(motion: Motion | Solution, shot: Shot | None = None) -> Any:
    """Return the film as the sound needs it; every body, and ground, is a bar of steel."""
    if not isinstance(motion, Motion):
        motion = to_motion(motion, None, "0" * 64, {})
    shot = shot or Shot()
    corners = np.array([[x, y, 0.0] for x in (-SIZE / 2, SIZE / 2) for y in (-SIZE / 2, SIZE / 2)])
    return SimpleNamespace(
        motion=motion,
        shot=shot,
        clock=Clock(motion, shot),
        poses=Poses(motion),
        parts=SimpleNamespace(mount=Mount(), bodies={name: bar() for name in ("ground", *motion.bodies)}),
        aspect=16 / 9,
        travel=None,
        size=SIZE,
        space=SimpleNamespace(machine=corners, middle=np.zeros(3)),
    )


def ball(seconds: float = 1.0) -> Solution:
    """A ball that falls 0.1 m on the floor, and bounces."""
    m = Mechanism("ball", gravity=(0.0, -9.81))
    body = m.body("ball", mass=0.1, inertia=1e-5)
    m.rigid_contact("floor", m.ground.origin, body.origin, 0.01, 0.7)
    m.start_near(ball=(0.0, 0.11, 0.0))
    return m.simulate(seconds, steps=200)


def gears(turns: float = 10.0, teeth: tuple[int, int] = (20, 20)) -> Solution:
    """Two wheels, the first of which makes so many turns a second against a torque."""
    m = Mechanism("gears")
    first, second = m.body("first", mass=0.2, inertia=1e-4), m.body("second", mass=0.2, inertia=1e-4)
    m.revolute("A", m.ground.at(0.0, 0.0), first.origin)
    m.revolute("B", m.ground.at(0.001 * sum(teeth), 0.0), second.origin)
    m.gear_pair("mesh", first.origin, second.origin, teeth=teeth, module=0.002)
    m.drive_angle("motor", first, constant_rate(2 * np.pi * turns))
    m.torque("load", second, 0.5)
    m.start_near(first=0, second=0)
    return m.sweep(steps=180)


def short_term(wave: np.ndarray, step: float) -> np.ndarray:
    """Loudness (LUFS) of each 3 s of waves (2, n), a ``step`` (s) after each other, as EBU R 128 weighs them."""
    square = energies(np.fft.rfft(wave), wave.shape[1])
    sums, every = np.concatenate([[0.0], np.cumsum(square)]), round(1000 * step)
    starts = np.arange(0, len(square) - 3000, every)
    return -0.691 + 10 * np.log10(np.maximum((sums[starts + 3000] - sums[starts]) / 3000, 1e-10))


def measured(file: Path) -> tuple[float, float]:
    """Integrated loudness (LUFS) and true peak (dBTP) of a film or WAV, by ffmpeg's own filter."""
    command = [ffmpeg(), "-hide_banner", "-nostats", "-i", str(file), "-map", "0:a", "-af", "ebur128=peak=true"]
    said = subprocess.run([*command, "-f", "null", "-"], capture_output=True, text=True, check=True).stderr
    summary = said[said.rindex("Summary:") :]
    loudness, peak = (re.search(rf"{word}:\s+(-?[\d.]+|-inf)", summary) for word in ("I", "Peak"))
    assert loudness is not None
    assert peak is not None
    return float(loudness[1]), float(peak[1])
