"""Heat release of combustion, and the motion of pistons that it drives."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from mbsd import ModelError
from mbsd.model.cylinders.cycle import HeatRelease, closed_pressure
from mbsd.model.cylinders.engine_cylinder import given_motion
from mbsd.model.cylinders.piston_motion import ArticulatedMotion, PistonMotion

# Pressure of a charge that burns, against the published case of Ferguson and Kirkpatrick.


CASE = json.loads((Path(__file__).parents[1] / "published/reference/engine_wiebe.json").read_text())
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


# How cranks let pistons down: derivatives, dead centres, and the throw that a given stroke needs.


PHI = np.linspace(-math.pi, math.pi, 73)
MOTIONS = {
    "centred": PistonMotion(0.04, 0.13),
    "offset": PistonMotion(0.04, 0.13, 0.012),
    "clockwise": PistonMotion(0.04, 0.13, -0.02, -1.0),
    "yoke": PistonMotion(0.04),
    "hung": ArticulatedMotion(0.04, 0.15, 0.0, (0.02, 0.028), 1.2, 0.115, 0.0),
    "hung, offset and clockwise": ArticulatedMotion(0.04, 0.15, 0.008, (-0.03, 0.01), -2.4, 0.12, -0.01, -1.0),
}


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS.keys())
def test_the_slope_is_that_of_the_way_and_zero_at_the_top(motion: PistonMotion | ArticulatedMotion) -> None:
    step = 1e-5
    slope = (motion.below(PHI + step) - motion.below(PHI - step)) / (2 * step)
    assert motion.slope(PHI) == pytest.approx(slope, abs=1e-10)
    assert motion.below(np.zeros(1)) == pytest.approx(0.0, abs=1e-16)
    assert motion.slope(np.zeros(1)) == pytest.approx(0.0, abs=1e-12)
    fine = motion.below(np.linspace(-math.pi, math.pi, 20001))
    assert fine.min() >= -1e-16
    assert fine.max() == pytest.approx(motion.stroke, rel=1e-7)


def test_a_rod_that_hangs_at_the_big_end_is_one_of_its_own() -> None:
    hung = ArticulatedMotion(0.04, 0.15, 0.0, (0.0, 0.0), 0.9, 0.13, 0.01)
    own = PistonMotion(0.04, 0.13, 0.01)
    assert hung.below(PHI) == pytest.approx(own.below(PHI), abs=1e-15)
    assert hung.reach == pytest.approx(own.reach)
    assert math.remainder(hung.top - 0.9 - own.top, 2 * math.pi) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("offset", [0.0, 0.015])
def test_a_given_stroke_finds_its_throw(offset: float) -> None:
    assert given_motion("gas", 0.09, 0.14, offset, 1.0).stroke == pytest.approx(0.09, rel=1e-13)
