"""The solve stage, and motions solved again after a change."""

from __future__ import annotations

import functools
import gc
import importlib
import random
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, MechanismError, angle_reaches, constant_rate
from mbsd.base.running import Kept
from mbsd.measures import final, largest
from mbsd.model.mechanism import connections
from mbsd.numbers.names import Number, known_numbers, number_in
from mechanisms.stages.solve.masses import give_masses
from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.stages.solve.stage import solve
from shared import contract
from shared.stage.errors import UserError
from shared.stage.paths import planar_names
from tests.mechanisms.author_project import Author

# Masses from parts to model, what is refused, and the motion as the contract has it.


def _mechanism() -> Mechanism:
    m = Mechanism("arm")
    arm = m.bar("arm", 0.2)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_angle("motor", arm, constant_rate(6.0))
    m.trace("tip", arm.end)
    return m


def _parts(*names: str) -> contract.Parts:
    mass = contract.Mass(mass=0.3, com=(0.11, 0.01), inertia=2e-4, volume=1e-4)
    piece = contract.Piece(
        material="steel", stl="a.stl", step="a.step", mass=mass, z_range=(0.0, 0.01), triangles=12, stl_sha256="0"
    )
    return contract.Parts(
        mechanism="arm",
        provenance=contract.Provenance(inputs="x", versions={}),
        bodies={name: contract.BodyParts(pieces={"a": piece}, mass=mass, z=0.005) for name in names},
    )


def test_masses_of_the_parts_reach_model_and_file() -> None:
    m, parts = _mechanism(), _parts("ground", "arm")
    give_masses(m, parts)
    assert (m.bodies["arm"].mass, m.bodies["arm"].com, m.bodies["arm"].inertia) == (0.3, (0.11, 0.01), 2e-4)
    motion = to_motion(m.sweep(steps=8), parts, "key", {"numpy": "2"})
    arm = motion.bodies["arm"]
    assert (arm.mass, arm.com, arm.inertia, arm.z) == (0.3, (0.11, 0.01), 2e-4, 0.005)
    assert motion.period == pytest.approx(2 * 3.141592653589793 / 6.0)
    assert motion.joints["A"].bodies == ("ground", "arm")
    assert motion.drivers["motor"].kind == "angle"
    assert set(motion.points) == {"tip"}
    assert max(motion.drivers["motor"].effort) > 0.2


def _called(name: str) -> Mechanism:
    m = _mechanism()
    m.name = name
    return m


@pytest.mark.parametrize(
    ("build", "motion", "words"),
    [
        (lambda p: None, None, r"mechanism\.py: build\(\) returned None, .*; does it end with 'return m'\?"),
        (lambda p: 3.0, None, r"build\(\) returned a float"),
        (lambda p: _called("crank"), None, r"arm/mechanism\.py: build\(\) calls its mechanism 'crank', but the folder"),
        (lambda p: _mechanism(), lambda m, p: None, r"motion\(\) returned None; it must return a Solution"),
        (lambda: _mechanism(), None, r"mechanism\.py: .*\(\) is called with 1 argument: too many"),
        (lambda p: _mechanism(), lambda m: None, r"mechanism\.py: .*\(m\) is called with 2 arguments: too many"),
        (
            lambda p: _mechanism(),
            lambda m, p: _called("leg").sweep(steps=4),
            r"motion\(\) solved 'leg' with the bodies",
        ),
    ],
)
def test_files_without_a_model_or_a_solution_are_reported(
    monkeypatch: pytest.MonkeyPatch, build: Any, motion: Any, words: str
) -> None:
    Author(monkeypatch, build, **({} if motion is None else {"motion": motion}))
    with pytest.raises(UserError, match=words):
        solve("arm", _parts("ground", "arm"))


def test_a_point_in_millimetres_is_told_in_a_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def build(p: None) -> Mechanism:
        m = _mechanism()
        m.trace("P", m.bodies["arm"].at(60, 30))
        return m

    Author(monkeypatch, build, motion=lambda m, p: m.sweep(steps=4))
    solve("arm", _parts("ground", "arm"))
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("solve: warning: arm: trace P: its point (60, 30) on arm is")


def test_events_reach_the_file_with_both_of_their_rows(tmp_path: Path) -> None:
    m = Mechanism("arm", gravity=(0, -9.81))
    arm = m.bar("arm", 0.2, mass=0.3)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.event(
        "passes",
        angle_reaches(arm, -1.0),
        direction=-1,
        action=lambda moment: moment.set_velocity("arm", 0.0, 0.2, 2.0),
    )
    m.start_near(arm=0)
    motion = to_motion(m.simulate(0.25, steps=20, event_rows=True), _parts("ground", "arm"), "key", {})
    contract.write_motion(tmp_path / "data.json", motion)
    assert contract.read_motion(tmp_path / "data.json") == motion
    (event,) = motion.events
    before = motion.time.index(event.time)
    assert motion.time[before + 1] == event.time
    assert motion.bodies["arm"].omega[before] < -5.0
    assert motion.bodies["arm"].theta[before : before + 2] == pytest.approx([-1.0, -1.0], abs=1e-9)


def test_names_that_differ_are_told() -> None:
    with pytest.raises(UserError, match=r"it has: army; did you mean 'army'\? mechanism\.py and parts\.py must name"):
        give_masses(_mechanism(), _parts("ground", "army"))
    with pytest.raises(UserError, match=r"arm: parts\.py has no body 'arm'; it has: lever"):
        give_masses(_mechanism(), _parts("ground", "lever"))
    with pytest.raises(UserError, match=r"arm: mechanism\.py has no body 'lever'"):
        give_masses(_mechanism(), _parts("ground", "arm", "lever"))


def test_a_mass_of_mechanism_py_wins_over_that_of_the_parts() -> None:
    m = _mechanism()
    m.set_mass("arm", 0.5, (0.1, 0.0), 1e-3)
    source, (said,) = give_masses(m, _parts("ground", "arm"))
    assert source == {"arm": "mechanism"}
    assert (m.bodies["arm"].mass, m.bodies["arm"].com, m.bodies["arm"].inertia) == (0.5, (0.1, 0.0), 1e-3)
    assert said == "masses of mechanism.py count, not those of the parts: arm 500 g (parts 300 g)"
    m = _mechanism()
    assert give_masses(m, _parts("ground", "arm")) == ({"arm": "parts"}, [])


# A mechanism whose number changes after it was solved in every way has the digits of one that was built with it.


MASS, INERTIA = 0.3, 2e-4
"""Mass and inertia of bodies whose parts would have them (kg, kg m^2)."""
COUNT = 2
"""So many numbers of each mechanism change."""


def built(name: str) -> Mechanism:
    module = importlib.import_module(f"mechanisms.{name}.mechanism")
    m = module.build(module.Params())
    for body in list(m.bodies.values())[1:]:
        body.mass, body.inertia = body.mass or MASS, body.inertia or INERTIA
    return m


def numbers(m: Mechanism) -> Iterator[tuple[str, str]]:
    """Things and names of their numbers that can change in place, in a random order that is always the same."""
    things = [*(key for table in connections(m) for key in table), *m.bodies, *m.traces, "gravity"]
    every = [(thing, number) for thing in things for number in dict.fromkeys(known_numbers(m, thing))]
    random.Random(zlib.crc32(m.name.encode())).shuffle(every)
    for thing, name in every:
        try:
            number = number_in(m, thing, name, "the test")
            changed(number, m)
        except MechanismError:  # of a group that must change together
            continue
        if number.built is None:
            yield thing, name


def changed(number: Number, m: Mechanism) -> None:
    number.assign(m, 1.003 * number.value if number.value else 1e-3)


def solved(m: Mechanism) -> dict[str, list[np.ndarray] | str]:
    """Return the result of each way of solving, or the reason why it fails."""
    body = list(m.bodies)[1]
    every = {body: {"mass": [MASS, 1.1 * MASS]}}
    measures = {"last": final(f"{body}.x"), "far": largest(f"{body}.theta")}

    def many() -> list[np.ndarray]:
        runs = m.simulate_many(0.01, vary=every, measure=measures, steps=4)
        return [runs["last"], runs["far"]]

    def at_rest() -> list[np.ndarray]:
        rest = m.equilibrium()
        return [rest.solution.q, rest.solution.lam, rest.stiffness]

    def motion(solve: Callable[[], object]) -> Callable[[], list[np.ndarray]]:
        def arrays() -> list[np.ndarray]:
            sol = solve()
            return [getattr(sol, part) for part in ("t", "q", "v", "a", "lam")]

        return arrays

    ways: dict[str, Callable[[], list[np.ndarray]]] = {
        "sweep": motion(lambda: m.sweep(0.05, steps=3)),
        "simulate": motion(lambda: m.simulate(0.02, steps=3)),
        "independent": motion(lambda: m.simulate(0.02, steps=3, formulation="independent")),
        "equilibrium": at_rest,
        "modes": lambda: [np.array([mode.eigenvalue for mode in m.modes()])],
        "many": many,
    }
    out: dict[str, list[np.ndarray] | str] = {}
    for way, solved in ways.items():
        try:
            out[way] = solved()
        except MechanismError as error:
            out[way] = str(error)
    return out


def forget() -> None:
    """Drop everything that was kept of mechanisms solved before."""
    for thing in gc.get_objects():
        if type(thing) is Kept:
            thing._results.clear()
        elif type(thing) is functools._lru_cache_wrapper and str(thing.__module__).startswith("mbsd"):
            thing.cache_clear()


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", planar_names())
def test_digits_are_those_of_one_built_so(name: str) -> None:
    tried = 0
    for thing, number in numbers(built(name)):
        m, fresh = built(name), built(name)
        before = solved(m)
        changed(number_in(m, thing, number, "the test"), m)
        changed(number_in(fresh, thing, number, "the test"), fresh)
        again = solved(m)
        forget()
        anew = solved(fresh)
        assert any(not isinstance(value, str) for value in before.values()), before
        for way, wanted in anew.items():
            got = again[way]
            if isinstance(wanted, str) or isinstance(got, str):
                assert got == wanted, (way, thing, number)
            else:
                assert all(map(np.array_equal, got, wanted)), (way, thing, number)
        tried += 1
        if tried == COUNT:
            break
    assert tried == COUNT
