"""Motions from mechanism.py alone: driven, simulated, with masses given, estimated, or of the parts."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.solve import stage as solve_stage
from mechanisms.stages.solve.masses import HALF_WIDTH, THICKNESS, bare_solution, estimated_masses, give_masses
from shared.contract import read_motion
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.mechanisms.author_project import Author, Project, write_file

PENDULUM = """
from mbsd import Mechanism


class Params:
    length = 0.3


def build(p):
    m = Mechanism("arm")
    arm = m.bar("arm", p.length{mass})
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.start_near(arm=-60)
    return m
"""


def _pendulum(p: None = None) -> Mechanism:
    m = Mechanism("arm")
    arm = m.bar("arm", 0.3)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.start_near(arm=-60)
    return m


def _crank(p: None = None) -> Mechanism:
    m = _pendulum()
    m.drive_angle("motor", m.bodies["arm"], constant_rate(4 * math.pi))
    return m


def test_a_driven_mechanism_is_swept_over_its_period(monkeypatch: pytest.MonkeyPatch) -> None:
    Author(monkeypatch, _crank)
    solution = bare_solution("arm")
    assert solution.period == pytest.approx(0.5)
    assert len(solution.t) == 361


def test_a_geared_mechanism_is_swept_until_all_is_back(monkeypatch: pytest.MonkeyPatch) -> None:
    def build(p: None) -> Mechanism:
        m = _crank()
        wheel = m.body("wheel")
        m.revolute("B", m.ground.at(0.06, 0), wheel.origin)
        m.gear_pair("mesh", m.bodies["arm"].start, wheel.origin, radius_i=0.02, radius_j=0.04)
        return m

    Author(monkeypatch, build)
    solution = bare_solution("arm")
    assert solution.period == pytest.approx(1.0)  # two turns of the motor
    assert len(solution.t) == 721


def test_a_stated_duration_and_number_of_steps_count(monkeypatch: pytest.MonkeyPatch) -> None:
    Author(monkeypatch, _crank, DURATION=0.2, STEPS=10)
    solution = bare_solution("arm")
    assert solution.t[-1] == 0.2
    assert len(solution.t) == 11


def test_mechanisms_without_drivers_are_simulated(monkeypatch: pytest.MonkeyPatch) -> None:
    Author(monkeypatch, _pendulum, DURATION=0.5)
    solution = bare_solution("arm")
    assert solution.t[-1] == 0.5
    assert len(solution.t) == 361
    assert np.ptp(solution.energy.total) < 1e-6 * np.ptp(solution.energy.kinetic)
    assert np.ptp(solution.energy.kinetic) > 0.0
    arm = solution.mechanism.bodies["arm"]
    assert arm.mass > 0.0


@pytest.mark.parametrize(
    ("constants", "words"),
    [
        ({}, r"arm: 1 degree of freedom is not driven.*Write DURATION = 2\.0 .*mechanism\.py, or add a driver"),
        ({"DURATION": -1.0}, r"mechanism\.py: DURATION is -1\.0; it must be a number of seconds"),
        ({"DURATION": "2 s"}, r"DURATION is '2 s'"),
        ({"DURATION": 1.0, "STEPS": 1.5}, r"STEPS is 1\.5; it must be a whole number"),
        ({"DURATION": 1.0, "STEPS": True}, r"STEPS is True"),
    ],
)
def test_missing_and_invalid_constants_are_reported(
    monkeypatch: pytest.MonkeyPatch, constants: dict[str, Any], words: str
) -> None:
    Author(monkeypatch, _pendulum, **constants)
    with pytest.raises(UserError, match=words):
        bare_solution("arm")


def test_estimates_are_plates_through_the_markers() -> None:
    m = Mechanism("made")
    bar, block = m.bar("bar", 0.2), m.body("block")
    wheel, plate = m.body("wheel"), m.body("plate")
    m.revolute("A", m.ground.at(0, 0), bar.start)
    m.prismatic("guide", m.ground.at(0, 0), block.origin)
    m.rolling_disc("road", m.ground.at(0, -0.05), wheel.at(0, 0), radius=0.05)
    m.weld("W", m.ground.at(0, 0), plate.at(0.0, 0.0))
    m.trace("P", plate.at(0.1, 0.0))
    m.trace("Q", plate.at(0.0, 0.1))
    masses = estimated_masses(m)
    surface = 2700.0 * THICKNESS * 0.2
    r = HALF_WIDTH * 0.2
    a_bar = 0.2 * 2 * r + math.pi * r * r
    assert masses["bar"].mass == pytest.approx(surface * a_bar, rel=1e-3)
    assert masses["bar"].com == pytest.approx((0.1, 0.0), abs=1e-9)
    box = surface * 0.2 * 2 * r
    ends = surface * math.pi * r * r / 2  # each; centroid of a half disc at 4 r / (3 pi)
    c = 4 * r / (3 * math.pi)
    inertia = box * (0.2**2 + 4 * r * r) / 12 + 2 * (ends * (r * r / 2 - c * c) + ends * (0.1 + c) ** 2)
    assert masses["bar"].inertia == pytest.approx(inertia, rel=2e-3)
    assert masses["block"].mass == pytest.approx(surface * math.pi * (2 * r) ** 2, rel=1e-3)
    assert masses["wheel"].mass == pytest.approx(surface * math.pi * 0.05**2, rel=1e-3)
    assert masses["wheel"].inertia == pytest.approx(masses["wheel"].mass * 0.05**2 / 2, rel=2e-3)
    corners = 0.1**2 / 2 + r * (0.2 + math.sqrt(0.02)) + math.pi * r * r
    assert masses["plate"].mass == pytest.approx(surface * corners, rel=1e-3)
    assert masses["plate"].com[0] == pytest.approx(masses["plate"].com[1])


def test_a_folder_without_parts_is_solved_and_says_how_heavy_it_took_its_bodies(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project = Project(tmp_path / "project", monkeypatch, solve_stage)
    write_file("mechanisms/arm/mechanism.py", PENDULUM.format(mass="") + "\nDURATION = 0.2\n")(project)
    assert project.run()
    said = capsys.readouterr().out
    assert "solve: arm: no parts yet, so masses are estimated" in said
    assert "arm 479 g" in said
    motion = read_motion(Out("arm").motion)
    assert motion.bodies["arm"].z is None
    assert motion.bodies["arm"].mass > 0.1
    assert motion.period is None
    assert not project.run()
    write_file("mechanisms/arm/mechanism.py", PENDULUM.format(mass=", mass=2.5") + "\nDURATION = 0.2\n")(project)
    assert project.run()
    assert "estimated" not in capsys.readouterr().out
    assert read_motion(Out("arm").motion).bodies["arm"].mass == 2.5


def _bouncing(p: None = None) -> Mechanism:
    """A ball on a stiff floor, which it touches for some milliseconds."""
    m = Mechanism("arm", gravity=(0.0, -9.81))
    ball = m.body("ball", mass=0.1, inertia=1e-5)
    m.contact("floor", m.ground.origin, ball.origin, stiffness=2e8, exponent=1.5, radius=0.02)
    m.start_near(ball=(0.0, 0.2, 0.0))
    return m


def test_rows_lie_so_close_that_the_film_shows_the_motion_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    """Between any two rows the quintic of the film is where a finer simulation is, also in a stiff contact."""
    from render.film.poses import hermite

    Author(monkeypatch, _bouncing, DURATION=1.0)
    solution, plain = bare_solution("arm"), _bouncing().simulate(1.0, 360)
    fine = np.linspace(0.0, 1.0, 20001)
    exact = _bouncing().simulate(times=fine).body("ball").y
    off = []
    for sol in (solution, plain):
        ball = sol.body("ball")
        off.append(np.abs(hermite(sol.t, ball.y, ball.vy, ball.ay, fine) - exact).max())
    assert off[0] < 5e-5  # m
    assert off[1] > 5e-4  # what equal steps would have shown
    assert 361 < len(solution.t) < 1000


def test_smooth_motions_get_no_more_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    Author(monkeypatch, _pendulum, DURATION=1.0)
    assert len(bare_solution("arm").t) == 361


def test_impacts_without_rows_of_their_own_are_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def build(p: None) -> Mechanism:
        m = Mechanism("arm", gravity=(0.0, -9.81))
        ball = m.body("ball", mass=0.1, inertia=1e-5)
        m.rigid_contact("floor", m.ground.origin, ball.origin, radius=0.02, restitution=0.5)
        m.start_near(ball=(0.0, 0.2, 0.0))
        return m

    Author(monkeypatch, build, motion=lambda m, p: m.simulate(0.25, steps=20))
    bare_solution("arm")
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("solve: warning: arm: 1 impact, the first 'floor' at 0.19")
    Author(monkeypatch, build, DURATION=0.25)
    bare_solution("arm")
    assert capsys.readouterr().err == ""


def test_a_mass_of_zero_is_massless_on_purpose() -> None:
    m = Mechanism("light")
    rod, arm, ring = m.bar("rod", 0.2, mass=0), m.bar("arm", 0.2), m.body("ring", mass=0, inertia=0.1)
    sources, sentences = give_masses(m, None)
    assert sources == {"rod": "mechanism", "arm": "estimate", "ring": "mechanism"}
    assert (rod.mass, rod.inertia, ring.mass, ring.inertia) == (0.0, 0.0, 0.0, 0.1)
    assert arm.mass > 0
    assert len(sentences) == 1
    assert "rod" not in sentences[0]


def test_the_first_of_many_masses_are_reported() -> None:
    m = Mechanism("many")
    for k in range(20):
        m.bar(f"bar{k}", 0.1)
    _, (sentence,) = give_masses(m, None)
    assert "bar7 " in sentence
    assert sentence.endswith(" and 12 others")
