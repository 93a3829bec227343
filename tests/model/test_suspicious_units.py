"""Numbers that look like a mixed-up unit are told once, with a remedy; sound mechanisms pass in silence."""

from __future__ import annotations

import importlib
import math
import re
import warnings
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, ModelWarning, constant_rate, cycloidal, harmonic
from mbsd.analyses.findings import Finding
from mbsd.saving.document import build, document
from shared.stage.paths import planar_names
from tools.models.linkages import four_bar
from tools.random_mechanisms import linkages


def _four_bar(scale: float = 1.0, **lengths: float) -> Mechanism:
    """The crank-rocker of 120, 40, 120, 90 mm with rods of 0.5 kg/m; single lengths may be changed."""
    sizes = {"ground": 0.12, "crank": 0.04, "coupler": 0.12, "rocker": 0.09} | lengths
    return four_bar(*(scale * size for size in sizes.values()), masses=(0.05, 0.05, 0.05), law=None)


def _of_units(m: Mechanism) -> list[Finding]:
    """Findings on numbers: rough starts here may be as near to both assemblies, or close in none."""
    return [
        finding
        for finding in m.check()
        if finding.name != "start" and "the links close in two ways" not in finding.problem and not finding.is_note
    ]


def _wire() -> Mechanism:
    m = Mechanism("pendulum")
    m.revolute("A", m.ground.origin, m.bar("crank", 40.0, 0.05).start)
    return m


def _rounded(far: float = 0.1 + 0.2) -> Mechanism:
    """A slider pinned and guided at one place, but for rounding."""
    m = _four_bar()
    slider = m.body("slider", 0.1)
    m.revolute("E", m.bodies["rocker"].end, slider.at(far, 0))
    m.prismatic("guide", m.ground.at(0, 0), slider.at(0.3, 0))
    return m


def _in_millimetres(gravity: float) -> Mechanism:
    m = _four_bar(scale=1000.0)
    m.gravity = (0.0, -gravity)
    return m


def _driven(law) -> Mechanism:
    m = _four_bar()
    m.drive_angle("motor", m.bodies["crank"], law)
    return m


def _with_slider(mass: float = 0.1, inertia: float = 0.0, com: tuple[float, float] = (0.0, 0.0)) -> Mechanism:
    m = _four_bar()
    slider = m.body("slider", mass, com, inertia)
    m.revolute("E", m.bodies["rocker"].end, slider.origin)
    return m


def _turned_marker(angle: float) -> Mechanism:
    m = _four_bar()
    slider = m.body("slider")
    m.prismatic("guide", m.ground.at(0, 0, angle), slider.origin)
    return m


def _traced(x: float, y: float) -> Mechanism:
    m = _four_bar()
    m.trace("P", m.bodies["coupler"].at(x, y))
    return m


def _started(**poses: float) -> Mechanism:
    m = _four_bar()
    m.start_near(**poses)
    return m


@pytest.mark.parametrize(
    ("m", "names", "says"),
    [
        (_four_bar(crank=40.0), ["crank"], "40 m long beside 120 mm of the others. Lengths are in metres: divide"),
        (_four_bar(ground=120.0), ["ground"], "120 m long beside 90 mm"),
        (
            _four_bar(scale=1000.0),
            ["lengths"],
            r"bodies are 105 m long, and crank, coupler, rocker of 0.05 kg .*divide all of them",
        ),
        (_wire(), ["crank"], "40 m long and 0.05 kg heavy, a wire"),
        (_with_slider(mass=1e6), ["slider"], "1e[+]06 kg beside 0.05 kg of the others. Masses are in kilograms"),
        (_with_slider(mass=1e-9), ["slider"], "1e-09 kg beside 0.05 kg"),
        (_with_slider(inertia=25.0), ["slider"], "make a radius of gyration of 15.81 m on a body of 105 mm"),
        (_with_slider(com=(20.0, 0.0)), ["slider"], "centre of mass is 20 m from its joints, 190 times its size"),
        (
            _traced(60.0, 30.0),
            ["trace P"],
            r"point \(60, 30\) on coupler is 66.97 m from the joints .* divide millimetres",
        ),
        (_turned_marker(90), ["guide"], r"marker on ground is turned by 90 rad. .* write math.radians\(90\)"),
        (_turned_marker(-45), ["guide"], r"write math.radians\(-45\)"),
        (_driven(constant_rate(1.0, 90)), ["motor"], r"start of its law is 90 rad, 14.3 turns. .*math.radians\(90\)"),
        (_driven(harmonic(30, 2.0)), ["motor"], "amplitude of its law is 30 rad"),
        (_driven(cycloidal(180, 1.0)), ["motor"], "rise of its law is 180 rad"),
        (_started(crank=math.pi / 2), ["crank"], "and 90 degrees in radians. start_near takes degrees: write 90"),
        (_started(rocker=-0.7854), ["rocker"], "write -45"),
    ],
)
def test_told_with_its_name_and_remedy(m: Mechanism, names: list[str], says: str) -> None:
    findings = _of_units(m)
    assert [finding.name for finding in findings] == names
    assert re.search(says, str(findings[0])), str(findings[0])


@pytest.mark.parametrize(("value", "unit"), [(9810.0, "mm/s"), (981.0, "cm/s")])
def test_gravity_in_millimetres_is_told(value: float, unit: str) -> None:
    (finding,) = Mechanism("x", gravity=(0.0, -value)).check()
    assert unit in finding.problem
    assert finding.remedy == "Gravity is in m/s^2: 9.81"


@pytest.mark.parametrize(
    "build",
    [
        _four_bar,
        lambda: _four_bar(crank=0.004),
        lambda: _with_slider(mass=0.0),
        lambda: _with_slider(mass=50.0, inertia=2.0),  # a flywheel
        lambda: _with_slider(inertia=1e-12),
        lambda: _traced(0.06, 0.03),
        lambda: _traced(1.0, -2.0),  # a long pointer
        lambda: _turned_marker(-math.pi),
        lambda: _turned_marker(2.0),
        lambda: _driven(constant_rate(-300.0, 7.5)),
        lambda: _driven(harmonic(0.5, 90.0)),
        lambda: _started(crank=1.5, coupler=3.0, rocker=0.0),
        lambda: _started(crank=90, coupler=-180.0),
        lambda: Mechanism("moon", gravity=(0.0, -1.62)),
        lambda: Mechanism("none", gravity=None),
    ],
)
def test_sound_mechanisms_pass_in_silence(build: Callable[[], Mechanism]) -> None:
    assert _of_units(build()) == []


def test_places_equal_but_for_rounding_are_one() -> None:
    assert 0.1 + 0.2 != 0.3
    assert _of_units(_rounded()) == []
    assert _of_units(_rounded(0.3 + 1e-12)) == []
    assert [finding.name for finding in _rounded(0.3 + 1e-6).check()] == ["slider"]


@pytest.mark.parametrize("seed", range(12))
def test_a_model_in_millimetres_is_told_in_one_sentence(seed: int) -> None:
    written = document(linkages.linkage(seed, 1 + seed % 4).m)
    assert build(written, Mechanism).check() == []
    for body in written["bodies"].values():
        body["com"] = [1000 * x for x in body["com"]]
    for joint in (*written["joints"].values(), *written["forces"].values()):
        for marker in (joint["i"], joint["j"]):
            marker["x"], marker["y"] = 1000 * marker["x"], 1000 * marker["y"]
        if "length" in joint["params"]:
            joint["params"]["length"] *= 1000
    (finding,) = build(written, Mechanism).check()
    assert "they look like millimetres" in finding.problem


def test_gravity_in_millimetres_joins_that_sentence() -> None:
    (finding,) = _in_millimetres(9810.0).check()
    assert "gravity looks like mm/s^2" in finding.problem
    assert finding.remedy == "Lengths are in metres: divide all of them by 1000, and gravity"


def test_a_long_chain_is_no_mixture_of_units() -> None:
    m = Mechanism("chain")
    before = m.ground.at(0, 0)
    for k in range(400):
        link = m.bar(f"link{k}", 0.1, 0.1)
        m.revolute(f"J{k}", before, link.start)
        m.distance(f"R{k}", m.ground.at(0.1 * k, 1.0), link.end, 1.0)
        before = link.end
    assert m.check() == []


@given(
    lengths=st.fixed_dictionaries({n: st.floats(0.05, 0.4) for n in ("ground", "crank", "coupler", "rocker")}),
    wrong=st.sampled_from(["ground", "crank", "coupler", "rocker"]),
    factor=st.sampled_from([1e-3, 1e3]),
)
def test_one_length_in_another_unit_is_always_found(lengths: dict[str, float], wrong: str, factor: float) -> None:
    assert _of_units(_four_bar(**lengths)) == []
    findings = _four_bar(**lengths | {wrong: factor * lengths[wrong]}).check()
    assert [finding.name for finding in findings if "long beside" in finding.problem] == [wrong]


@pytest.mark.parametrize("name", planar_names())
def test_the_mechanisms_of_the_project_pass(name: str) -> None:
    module = importlib.import_module(f"mechanisms.{name}.mechanism")
    assert [finding for finding in module.build(module.Params()).check() if not finding.is_note] == []


def test_the_first_solution_tells_and_the_second_does_not() -> None:
    m = _driven(constant_rate(1.0, 180 * 4))
    with pytest.warns(ModelWarning, match=r"four_bar: motor: start of its law is 720 rad") as told:
        m.sweep(steps=4)
    assert len(told) == 1
    assert told[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        m.sweep(steps=4)


def _braced(stiffness: float = 5e3) -> Mechanism:
    m = Mechanism("braced")
    arm = m.bar("arm", 0.1, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.spring("brace", m.ground.at(0.1, 0.1), arm.end, stiffness, free_length=0.1)
    return m


def test_a_spring_like_a_solid_bar_is_named() -> None:
    assert _braced(2e6).check() == []
    (finding,) = _braced(5e9).check()
    assert finding.name == "spring 'brace'"
    assert "5e+09 N/m is more than that of a steel bar" in finding.problem


@pytest.mark.parametrize(("pressure", "odd"), [(5.0, True), (900.0, True), (5e5, False), (1100.0, False)])
def test_a_pressure_in_bar_is_named(pressure: float, odd: bool) -> None:
    m = _braced()
    piston = m.body("piston", mass=0.3)
    m.prismatic("guide", m.ground.at(0, 0), piston.origin)
    m.start_near(piston=(0.05, 0, 0))
    m.gas("gas", m.ground.at(0.15, 0), piston.origin, area=2e-3, pressure=pressure, at=0.1)
    sentences = [str(finding) for finding in m.check()]
    assert any("multiply bar by 1e5" in words and "force 'gas'" in words for words in sentences) == odd


def test_a_weld_beside_a_pin_is_named() -> None:
    m = _braced()
    other = m.bar("other", 0.1, mass=1.0)
    m.revolute("B", m.bodies["arm"].end, other.start)
    assert m.check() == []
    m.weld("W", m.bodies["arm"].end, other.start)
    (finding,) = m.check()
    assert (finding.name, "'B' connects as well" in finding.problem) == ("weld 'W'", True)
