"""Pressure of a charge that burns, against the published case of Ferguson and Kirkpatrick."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from mbsd import ModelError
from mbsd.model.cylinders.cycle import HeatRelease, closed_pressure

CASE = json.loads((Path(__file__).parents[2] / "published/reference/engine_wiebe.json").read_text())
GIVEN = CASE["given"]


def volume(phi: np.ndarray) -> np.ndarray:
    """Over that at the bottom dead centre, of the ideal cycle without the rod's obliquity."""
    return (1 + (GIVEN["compression_ratio"] - 1) / 2 * (1 - np.cos(phi))) / GIVEN["compression_ratio"]


def pressure(phi: np.ndarray, release: HeatRelease) -> np.ndarray:
    return closed_pressure(phi, volume, 1.0, release, GIVEN["exponent"], GIVEN["exponent"])


@pytest.mark.parametrize("engine", CASE["expected"], ids=lambda engine: f"{engine['start']} degrees")
def test_the_wiebe_case(engine: dict) -> None:
    start, duration = (math.radians(angle) for angle in (engine["start"], GIVEN["duration"]))
    release = HeatRelease(GIVEN["heat"], start, duration, GIVEN["a"], GIVEN["n"])
    angles = np.radians([float(angle) for angle in engine["pressure"]])
    order = np.argsort(angles)
    got = pressure(angles[order], release)
    assert got == pytest.approx(np.array(list(engine["pressure"].values()))[order], rel=CASE["tolerance"])
    fine = np.radians(np.arange(engine["at"] - 0.05, engine["at"] + 0.05, 1e-4))
    peak = pressure(fine, release)
    assert peak.max() == pytest.approx(engine["peak"], rel=CASE["tolerance"])
    assert math.degrees(fine[peak.argmax()]) == pytest.approx(engine["at"], abs=2e-4)


@pytest.mark.parametrize("engine", CASE["expected"], ids=lambda engine: f"{engine['start']} degrees")
def test_the_work_of_the_cycle(engine: dict) -> None:
    release = HeatRelease(GIVEN["heat"], math.radians(engine["start"]), math.radians(GIVEN["duration"]))
    phi = np.linspace(-math.pi, math.pi, 7201)
    p, v = pressure(phi, release), volume(phi)
    work = float((0.5 * (p[1:] + p[:-1]) * np.diff(v)).sum())
    assert work == pytest.approx(engine["work"], rel=1e-5)
    assert work / GIVEN["heat"] == pytest.approx(engine["efficiency"], rel=1e-5)


def test_without_heat_it_is_a_spring() -> None:
    phi = np.linspace(-math.pi, math.pi, 91)
    got = pressure(phi, HeatRelease(0.0, -0.3, 0.7))
    assert got == pytest.approx(volume(phi) ** -1.4, rel=1e-12)


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({"heat": -1.0}, "heat is -1"),
        ({"duration": 0.0}, "duration is 0"),
        ({"start": -20.0}, "give radians"),
        ({"n": math.nan}, "n is nan"),
    ],
)
def test_bad_numbers_are_refused(numbers: dict, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        HeatRelease(**{"heat": 1.0, "start": -0.3, "duration": 0.7, **numbers})
