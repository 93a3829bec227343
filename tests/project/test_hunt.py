"""The hunt: a few of its cases, and that it finds what is wrong, what hangs and what dies."""

from __future__ import annotations

import importlib
import json
import math
import os
import time
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, function, table
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import CONTACT_KINDS, KINDS
from mbsd.model.laws.examples import EXAMPLES
from tools.hunt import case, moved_derivatives, pool
from tools.hunt.__main__ import hunt
from tools.hunt.agreement import SAME, Growth, Words, compare_driven, compare_free, of_law
from tools.hunt.checks import driven_problems, odd_steps, one_assembly, smooth
from tools.hunt.free_case import Free, nudged
from tools.hunt.moved_derivatives import beside_its_own
from tools.hunt.outcome import AGREED, BASE, HUNG, WRONG, CaseResult, Outcome
from tools.hunt.pool import results
from tools.models.four_bars import angles, model
from tools.random_mechanisms import free
from tools.random_mechanisms.contacts import audited
from tools.random_mechanisms.described import on_a_base, seen_from
from tools.random_mechanisms.families import all_families
from tools.random_mechanisms.similar import exchanged, mirrored, shuffled
from tools.random_mechanisms.subject import TOLERANCE, Subject

LENGTHS = (0.4, 0.1, 0.38, 0.3)


# -- the hunt itself --------------------------------------------------------------------------------------------------


def test_a_short_hunt_finds_nothing(out_root: Path) -> None:
    assert hunt(16, seed=8, jobs=1) == 0
    report = json.loads((out_root / "hunt.json").read_text())
    assert report["cases"] == 16
    assert report["solutions"]["agreed"] > 50
    assert report["solutions"]["wrong"] == report["solutions"]["hung"] == 0


def test_a_case_is_the_same_each_time() -> None:
    first, second = case.run(5, "yoke"), case.run(5, "yoke")
    assert first.outcomes == second.outcomes
    assert len(first.outcomes) == 1 + case.VARIATIONS


def test_every_kind_of_the_registries_is_hunted() -> None:
    names = set(all_families())
    assert {f"example of force {name}" for name in FORCE_KINDS} <= names
    assert {f"example of contact {name}" for name in CONTACT_KINDS} <= names
    joints = {f"example of {'driver' if kind.driven else 'joint'} {name}" for name, kind in KINDS.items()}
    assert {name for name in joints if name.split()[-1] not in CONTACT_KINDS} <= names
    assert sum(name.startswith("example of law") for name in names) == len(EXAMPLES)


# -- the pool ---------------------------------------------------------------------------------------------------------


def odd_one(seed: int) -> CaseResult:
    """Case 1 never ends, case 2 kills its process, case 3 raises."""
    if seed == 1:
        time.sleep(1000)
    if seed == 2:
        os._exit(7)
    if seed == 3:
        raise RuntimeError("broken")
    return CaseResult(seed, "fine", [Outcome(BASE, AGREED)])


def test_hanging_and_dying_cases_are_counted_and_the_rest_goes_on() -> None:
    outcomes = {result.seed: result.outcomes[-1] for result in results(range(6), odd_one, jobs=1, limit=1.0)}
    assert sorted(outcomes) == list(range(6))
    assert outcomes[1].state == HUNG
    assert outcomes[2].state == WRONG
    assert "exit code 7" in outcomes[2].reason
    assert outcomes[3].state == WRONG
    assert "broken" in outcomes[3].reason
    assert all(outcomes[k].state == AGREED for k in (0, 4, 5))


def slow_kernels(seed: int) -> CaseResult:
    """A case for which numba compiles three times, and reads a kernel from its cache in between."""
    from numba.core.event import trigger_event

    for seconds in (0.3, 0.01, 0.3, 0.01, 0.3):
        with trigger_event("numba:compile", data={"dispatcher": SimpleNamespace(py_func=slow_kernels)}):
            time.sleep(seconds)
    return CaseResult(seed, "fine", [Outcome(BASE, AGREED)])


@pytest.mark.parametrize(("patience", "words"), [(0.5, 1), (1000.0, 0)])
def test_who_waits_for_kernels_is_told_once(patience: float, words: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pool, "KERNEL", 0.25)
    monkeypatch.setattr(pool, "PATIENCE", patience)
    said: list[bool] = []
    finished = list(results(range(2), slow_kernels, jobs=1, notice=lambda: said.append(True)))
    assert [result.outcomes[-1].state for result in finished] == [AGREED, AGREED]
    assert len(said) == words


def test_faults_end_in_an_exit_code(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        case, "run", partial(_replayed, outcome=Outcome("12 outputs a turn", WRONG, "differs", "by 1 m"))
    )
    assert hunt(2, seed=1, jobs=1) == 1
    report = json.loads((out_root / "hunt.json").read_text())
    assert report["found_cases"]["wrong"] == 2
    assert report["findings"][0]["seed"] == 1_000_000


def _replayed(seed: int, name: str | None, outcome: Outcome) -> CaseResult:
    return CaseResult(seed, "made up", [replace(outcome)])


# -- other words, and judging -----------------------------------------------------------------------------------------


def test_other_words_move_alike_and_other_numbers_do_not() -> None:
    m = model(LENGTHS, 6.0, {"coupler": (1.0, (0.1, 0.05), 0.2), "rocker": (0.5, (0.2, 0.0), 0.1)})
    m.torsion_spring("coil", m.ground, m.bodies["rocker"], 2.0, 0.1, 0.3)
    first, rng = m.sweep(steps=90), np.random.default_rng(3)
    frames = {"ground": (0.3, -2.0, 0.8), "crank": (0.1, 0.2, -1.0), "coupler": (0.3, 0.0, 2.0)}
    base = (1.0, -0.4, 2.5)
    away = {"ground": (*_turned_back(base), -2.5)}
    for other, words in (
        (seen_from(m, frames), Words(frames)),
        (shuffled(m, rng), SAME),
        (exchanged(m, rng), SAME),
        (on_a_base(m, base, 1.0), Words(away)),
    ):
        verdict = compare_driven(first, other.sweep(steps=90), words)
        assert verdict.agrees, verdict.words
        assert verdict.compared == 91
    m.change("coil", stiffness=2.001)
    assert not compare_driven(first, m.sweep(steps=90)).agrees


@pytest.mark.parametrize("machine", ["wheels by teeth and a torque", "gears with play", "an engine"])
def test_numbers_of_wheels_torques_and_engines_go_with_the_words(machine: str) -> None:
    m, frames = Mechanism("machine"), {"ground": (0.3, -2.0, 0.8), "rotor": (0.1, 0.2, -1.0)}
    others: list[tuple[Mechanism | None, Words]]
    if machine == "an engine":
        module = importlib.import_module("mechanisms.v6.mechanism")
        m = module.build(module.Params())
        frames = {"crank": (0.01, 0.0, 0.7), "rod_1": (0.0, 0.01, -2.0)}
        first = m.sweep(steps=72)
        verdict = compare_driven(first, seen_from(m, frames).sweep(times=first.t), Words(frames))
        assert verdict.agrees, verdict.words
        return
    rotor, wheel = m.body("rotor", mass=1.0, inertia=0.01), m.body("wheel", mass=2.0, inertia=0.04)
    m.revolute("A", m.ground.at(0, 0), rotor.origin)
    m.revolute("B", m.ground.at(0.08, 0), wheel.origin)
    m.torsion_spring("load", m.ground, wheel, 0.3)
    m.torque("push", rotor, 0.4)
    if machine == "gears with play":
        m.start_near(rotor=20, wheel=30)
        m.start_moving(rotor=2.0)
        m.gear_mesh("gears", rotor.origin, wheel.origin, 1e4, 1e-3, teeth=(20, 60), module=0.002, phase=(0.35, 0.52))
        others = [(seen_from(m, frames), Words(frames)), (mirrored(m), Words(mirrored=True))]
    else:
        m.gear_pair("gears", rotor.origin, wheel.origin, teeth=(20, 60), module=0.002)
        turned = [exchanged(m, np.random.default_rng(seed)) for seed in range(4)]
        assert len({other.joints["gears"].i.body.name for other in turned}) == 2
        others = [*((other, SAME) for other in turned), (mirrored(m), Words(mirrored=True))]
    first = m.simulate(0.2, steps=20, tolerance=TOLERANCE)
    growth = Growth.between(first, nudged(m).simulate(0.2, steps=20, tolerance=TOLERANCE))
    for other, words in others:
        if other is None:
            assert machine == "gears with play", "a mesh has a side of its own"
            continue
        verdict = compare_free(first, other.simulate(0.2, steps=20, tolerance=TOLERANCE), growth, 2e-9, words)
        assert verdict.agrees, verdict.words
        assert verdict.compared == 21


@pytest.mark.parametrize("is_driven", [True, False])
def test_derivatives_of_the_moved_machine_are_its_own_and_those_of_another_are_not(
    is_driven: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    m = model(LENGTHS, 6.0, {"coupler": (1.0, (0.1, 0.05), 0.2), "rocker": (0.5, (0.2, 0.0), 0.1)})
    if not is_driven:
        m.drivers.clear()
        m.start_moving(crank=6.0)
    first = m.sweep(1.0, steps=60) if is_driven else m.simulate(0.5, steps=60, tolerance=TOLERANCE)
    again = None if is_driven else nudged
    pose = (0.3, -2.0, 0.8)

    def judged(seed: int) -> Outcome:
        rng = np.random.default_rng(seed)
        return beside_its_own("derivatives", m, rng, pose, first, not is_driven, again)

    assert [judged(seed).state for seed in range(6)] == [AGREED] * 6
    original = moved_derivatives.moved

    def another(m: Mechanism, *given: Any) -> moved_derivatives.Moved:
        m = seen_from(m, {})
        m.gravity = 0.0, -9.0  # what free motions start with stays
        m.joints["C"] = replace(m.joints["C"], i=m.bodies["coupler"].at(LENGTHS[2] + 0.004 * is_driven, 0.0))
        return original(m, *given)

    monkeypatch.setattr(moved_derivatives, "moved", another)
    assert WRONG in [judged(seed).state for seed in range(6)]


def _turned_back(pose: tuple[float, float, float]) -> tuple[float, float]:
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return -c * pose[0] - s * pose[1], s * pose[0] - c * pose[1]


def test_the_bound_of_free_motions_grows_with_what_a_nudge_comes_to() -> None:
    m = Mechanism("pendulum")
    rod = m.bar("rod", 1.0, 1.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.start_near(rod=-30)
    m.start_moving(rod=0.5)
    first = m.simulate(1.0, steps=20, tolerance=1e-9)
    growth = Growth.between(first, nudged(m).simulate(1.0, steps=20, tolerance=1e-9))
    assert 1.0 < growth.of["q"].max() < 100.0
    assert compare_free(first, m.simulate(1.0, steps=20, tolerance=1e-7), growth, 1e-7).agrees
    rod.mass, rod.inertia = 1.0, rod.inertia * 1.001
    assert not compare_free(first, m.simulate(1.0, steps=20, tolerance=1e-9), growth, 2e-9).agrees


def test_a_law_known_by_values_alone_errs_within_its_bound() -> None:
    for way, lasts in ((6.3, 0.4), (-12.6, 8.3)):
        w = 2 * math.pi / lasts
        law = function(lambda t, way=way, lasts=lasts, w=w: 0.7 + way * (t / lasts + 0.05 * math.sin(w * t)))
        for end in (lasts, 0.97 * lasts, 0.3 * lasts):
            t = np.linspace(0.0, end, 5001)
            off = np.abs(law.over(0.0, end)(t)[:, 1:] - _exact(way, lasts, t)).max(axis=0)
            bound = of_law(law, 0.0, end)
            assert 0.1 * bound.slope < off[0] < bound.slope
            assert 0.1 * bound.bend < off[1] < bound.bend < 1e-7 * abs(way) * 0.05 * w**2
    assert of_law(constant_rate(3.0), 0.0, 1.0).bend == 0.0


def test_a_table_errs_as_its_values_are_rounded() -> None:
    t = np.linspace(0.0, 0.3, 41)
    values = np.round(np.sin(5.0 * t), 9)
    plain, far = table(t, values), table(t, values + 1000.0)
    off = np.abs(far(t)[:, 1:] - plain(t)[:, 1:]).max(axis=0)
    bound = of_law(far, 0.0, 0.3)
    assert 0.01 * bound.slope < off[0] < bound.slope
    assert 0.01 * bound.bend < off[1] < bound.bend


def _exact(way: float, lasts: float, t: np.ndarray) -> np.ndarray:
    w = 2 * math.pi / lasts
    return np.stack([way / lasts + way * 0.05 * w * np.cos(w * t), -way * 0.05 * w**2 * np.sin(w * t)], axis=1)


def test_solutions_over_other_spans_agree_where_a_law_is_known_by_values_alone() -> None:
    m = Mechanism("disc")
    disc = m.body("disc", 2.0, (0.05, 0.02), 0.1)
    m.rolling_disc("road", m.ground.origin, disc.origin, 0.2)
    m.drive_angle("motor", disc, function(lambda t: 6.3 * (t / 8.3 + 0.05 * math.sin(2 * math.pi * t / 8.3))))
    m.start_near(disc=(0.0, 0.2, 0.0))
    times = np.linspace(0.0, 8.3, 361)
    verdict = compare_driven(m.sweep(times=times), m.sweep(times=times[:350]))
    assert verdict.agrees, verdict.words
    assert verdict.worst > 1e-4
    first = m.sweep(times=times)
    assert not compare_driven(first, replace(first, a=first.a * (1 + 1e-6))).agrees


def test_contradicting_velocities_start_alike_in_all_words_of_a_refused_motion() -> None:
    """A joint keeps components that depend on the axes: the centres approach, or go apart."""
    m = Mechanism("loose", gravity=None)
    ring, gear = m.body("ring", 2.0, inertia=1.0), m.body("gear", 1.0, inertia=0.1)
    m.gear_pair("mesh", ring.origin, gear.origin, radius_i=0.5, radius_j=0.2, internal=True)
    m.start_near(ring=(0, 0, 0), gear=(0.3 * math.cos(0.165), 0.3 * math.sin(0.165), 0))
    m.start_moving(ring=(0.0, 0.0, 0.0), gear=(-1.0, 1.0, 0.0))
    result = CaseResult(1, "loose")
    case._free(Subject(m, 1.0, False), np.random.default_rng(1), result, True)
    assert "the centres of gear_pair 'mesh' meet" in result.outcomes[0].detail
    assert not [outcome for outcome in result.outcomes if outcome.state == WRONG]


def test_accelerations_that_jump_up_and_down_within_a_step_are_no_left_branch() -> None:
    subject = case.drawn(41_007_313, "cam", skipped=2)[1]
    assert "jumps" in subject.traits
    sol = subject.m.sweep(times=np.linspace(0.0, subject.duration, round(90 * subject.turns) + 1))
    assert not driven_problems(sol, subject)
    q = sol.q.copy()
    q[40:, -1, 2] += 0.02
    assert smooth(replace(sol, q=q))


def test_accelerations_that_rise_and_fall_within_a_step_are_no_left_branch() -> None:
    """At the end of this curve its slope goes from 1 to 8 within one step."""
    subject = case.drawn(41_009_895, "point on a curve", skipped=2)[1]
    sol = subject.m.sweep(times=np.linspace(0.0, subject.duration, round(90 * subject.turns) + 1))
    assert odd_steps(sol)
    assert not smooth(sol)
    q = sol.q.copy()
    q[40:, -1, 2] += 0.02
    assert smooth(replace(sol, q=q))


def test_random_cams_can_be() -> None:
    for seed in range(150):
        case.drawn(seed, "cam")
    assert case.drawn(41_004_273)[1] is not None


def test_a_left_branch_is_seen_by_its_sign_and_by_its_steps() -> None:
    m = model(LENGTHS, 6.0)
    sol = m.sweep(steps=360)
    subject = Subject(m, float(sol.t[-1]))
    assert not smooth(sol)
    assert not one_assembly(sol, subject)
    theta, _ = angles(LENGTHS, 6.0 * sol.t[180:])
    line = np.arctan2(-LENGTHS[1] * np.sin(6.0 * sol.t[180:]), LENGTHS[0] - LENGTHS[1] * np.cos(6.0 * sol.t[180:]))
    q = sol.q.copy()
    q[180:, 2, 2] = 2 * line - theta
    mirrored = LENGTHS[1] * np.exp(6j * sol.t[180:]) + LENGTHS[2] * np.exp(1j * q[180:, 2, 2])
    q[180:, 3, 2] = np.angle(mirrored - LENGTHS[0])
    jumped = replace(sol, q=q)
    assert smooth(jumped)
    assert one_assembly(jumped, subject)


@pytest.mark.parametrize("kind", ["four-bar, crank turns", "slider-crank", "six-bar and more", "Geneva wheel", "yoke"])
def test_closed_forms_tell_a_small_error(kind: str) -> None:
    drawn = (case.drawn(seed, kind)[1] for seed in range(50))
    subject = next(candidate for candidate in drawn if candidate.possible and candidate.distance > 0.1)
    assert subject.truth is not None
    sol = subject.m.sweep(times=np.linspace(0.0, subject.duration, 721))
    assert not subject.truth(sol)
    q = sol.q.copy()
    q[300, -1] += 1e-5
    assert subject.truth(replace(sol, q=q))


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.ModelWarning")
def test_steps_of_links_that_snap_are_no_fault_and_those_of_rounding_are() -> None:
    """The steps of the first grow with the tolerance as the method's order says; 29194 were taken instead of 28."""
    _, snapping, rng = case.drawn(1_006_454, "masses far apart")
    sol = snapping.m.simulate(times=Free(snapping, rng).grid, tolerance=TOLERANCE)
    assert sol.stats.steps > free.STEPS
    assert snapping.truth is not None
    assert not snapping.truth(sol)
    _, usual, _ = case.drawn(10, "masses far apart")
    few = usual.m.simulate(times=[0.0, usual.duration], tolerance=TOLERANCE)
    assert usual.truth is not None
    assert not usual.truth(few)
    many = SimpleNamespace(stats=SimpleNamespace(steps=29194), t=few.t, mechanism=usual.m)
    (problem,) = usual.truth(many)  # pyright: ignore[reportArgumentType]
    assert problem.startswith("29194 steps, 2")


def test_energy_that_an_interpolant_misses_is_told_from_energy_that_is_lost() -> None:
    _, subject, rng = case.drawn(1_006_863, "free Geneva")
    sol = subject.m.simulate(times=Free(subject, rng).grid, tolerance=TOLERANCE)
    assert sol.audit is not None
    assert np.ptp(sol.audit) > 1e-8 * sol.energy.kinetic.max()
    assert not audited(sol)
    steps = SimpleNamespace(energy=sol.energy, audit=4e-8 * sol.energy.kinetic.max() * np.arange(2))
    steps.t, steps.mechanism = sol.t, SimpleNamespace(simulate=lambda **_: steps)
    assert audited(steps)  # pyright: ignore[reportArgumentType]


def test_a_geneva_whose_pin_is_at_the_mouth_within_rounding_goes_on() -> None:
    _, subject, rng = case.drawn(7_000_019, "free Geneva")
    sol = subject.m.simulate(times=Free(subject, rng).grid, tolerance=TOLERANCE)
    assert sol.stats.steps < 500


def test_no_motion_goes_on_from_within_a_contact_that_remembers_how_it_began() -> None:
    _, subject, rng = case.drawn(1_009_365, "contact with a restitution")
    it = Free(subject, rng)
    it.first, _ = it.run(it.m)
    assert it.first is not None
    inside = [it.remembers(k) for k in range(len(it.first.t))]
    assert 0 < sum(inside) < len(inside)
    assert not any(it.remembers(k) for k in np.flatnonzero(it.first.body("rod").y > 0.0))


def test_efforts_of_redundant_joints_are_judged_beside_the_forces_they_are_differences_of() -> None:
    _, subject, _ = case.drawn(1_009_130, "parallelogram, redundant")
    first = subject.m.sweep(times=np.linspace(0.0, subject.duration, 721))
    assert np.abs(first.wrench).max() > 100 * np.abs(first.driver("motor").effort).max()
    verdict = compare_driven(first, subject.m.sweep(times=np.linspace(0.0, subject.duration, 2881)))
    assert verdict.agrees, verdict.words
    assert 1e-4 < verdict.worst < 0.5
    subject.m.change("bar1", mass=subject.m.bodies["bar1"].mass * 1.01)
    assert not compare_driven(first, subject.m.sweep(times=np.linspace(0.0, subject.duration, 721))).agrees


def test_a_law_that_is_raised_is_still_of_its_kind() -> None:
    from tools.random_mechanisms.described import Raised, raised

    t = np.linspace(0.0, 1.4, 9)
    for law in EXAMPLES:
        ready = law.over(0.0, 1.4)
        for by, sign in ((0.3, 1.0), (-0.2, -1.0)):
            other = raised(law, by, sign)
            assert isinstance(other, type(law) | Raised)
            expected = sign * ready(t) + np.array([by, 0.0, 0.0])
            np.testing.assert_allclose(other.over(0.0, 1.4)(t), expected, atol=1e-9)
