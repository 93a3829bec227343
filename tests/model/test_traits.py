"""Traits of kinds, so that no code compares their names; and a user's kinds with the same traits."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mbsd import LimitError, Mechanism, ModelError, constant_rate, extend
from mbsd.drawing.topology import sign_of
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import KINDS
from mbsd.testing import check_joint, contact_kinds, force_kinds, joint_kinds
from mbsd.testing.forces import example
from shared.stage.paths import ROOT
from tools.models.guided import geneva


@pytest.fixture
def kinds(monkeypatch: pytest.MonkeyPatch) -> dict[str, extend.JointKind]:
    """A pin and a guide under other names, with the signs of those of the solver."""
    monkeypatch.setattr("mbsd.model.joint.KINDS", dict(KINDS))
    made = {}
    for name, of in (("hinge", "revolute"), ("sleeve", "prismatic")):
        kind = made[name] = extend.register_joint(
            extend.JointKind(
                name, KINDS[of].constraints, example=lambda m, i, j, name=name: _add(name, m, i, j), sign=of
            )
        )

        @kind.adds
        def add(m, name: str, i: extend.Marker, j: extend.Marker, limits: extend.Limits = None, kind=kind):
            return extend.join(m, kind, name, i, j, None, **extend.limits_given(m, name, limits))

    def _add(name, m, i, j):
        return made[name].add(m, "example", i, j)

    return made


def pendulum(kind: extend.JointKind, **more) -> Mechanism:
    m = Mechanism("pendulum")
    rod = m.bar("rod", 0.5, mass=1.0)
    assert kind.add is not None
    kind.add(m, "A", m.ground.origin, rod.start, **more)
    m.start_near(rod=-30)
    return m


def test_joints_know_how_their_bodies_move_on_each_other() -> None:
    pairs = {kind.name: kind.pair for kind in [*joint_kinds(), *contact_kinds()] if kind.pair}
    assert pairs == {"revolute": "pin", "prismatic": "guide", "pin_in_slot": "slot"}
    assert {kind.name for kind in joint_kinds() if kind.slides} == {"prismatic", "pin_in_slot"}


def test_forces_know_where_they_act() -> None:
    at_second, whole = set(), set()
    for kind in force_kinds():
        [force] = example(kind)[0].forces.values()
        if kind.places(force) == (force.j,):
            at_second.add(kind.name)
        if kind.on_bodies:
            whole.add(kind.name)
    assert at_second == {
        "force", "torque", "torsion_spring", "torsion_spring_law", "curve_of_angle", "user_force", "drag",
        "rotating_frame", "shaft",
    }  # fmt: skip
    assert whole == {"user_force", "rotating_frame"}
    assert {kind.name: kind.effort for kind in force_kinds() if kind.effort} == {
        "force": "force", "torque": "torque", "actuator": "force"
    }  # fmt: skip


def test_a_pin_of_ones_own_has_friction_stops_limits_and_the_sign(
    kinds: dict[str, extend.JointKind], tmp_path: Path
) -> None:
    own, usual = pendulum(kinds["hinge"]), pendulum(KINDS["revolute"])
    for m in (own, usual):
        m.friction("rubbing", "A", 0.2, radius=0.02, sticks=True)
        m.stop("end", m.joints["A"], lower=-2.5, restitution=0.4)
    a, b = (m.simulate(2.0, steps=20) for m in (own, usual))
    np.testing.assert_array_equal(a.q, b.q)
    assert own.contacts["end lower"].kind.name == "angle_stop"
    assert sign_of(own.joints["A"]) == sign_of(usual.joints["A"]) == "revolute"
    for name, m in (("own", own), ("usual", usual)):
        m.draw().save(tmp_path / f"{name}.svg")
    assert (tmp_path / "own.svg").read_bytes() == (tmp_path / "usual.svg").read_bytes()
    driven = pendulum(kinds["hinge"], limits=(-1.0, 1.0))
    driven.drive_angle("motor", driven.bodies["rod"], constant_rate(1.0))
    with pytest.raises(LimitError, match=r"'A' passes its upper limit of 57\.2958 degrees"):
        driven.sweep(2.0)


def test_a_guide_of_ones_own_has_stops_along_it(kinds: dict[str, extend.JointKind]) -> None:
    m = Mechanism("slider", gravity=None)
    block = m.body("block", 1.0, inertia=1.0)
    sleeve = kinds["sleeve"].add
    assert sleeve is not None
    joint = sleeve(m, "rail", m.ground.origin, block.origin)
    m.stop("end", joint, upper=0.5, restitution=1.0)
    m.friction("rubbing", joint, 0.1, length=0.2)
    m.start_moving(block=(1.0, 0.0, 0.0))
    assert m.contacts["end upper"].kind.name == "coordinate_stop"
    assert m.simulate(1.0, tolerance=1e-9).body("block").x[-1] == pytest.approx(0.0, abs=1e-6)
    with pytest.raises(ModelError, match="'rail': there is no argument 'reach'"):
        m.change("rail", reach=1.0)


def test_a_torque_of_ones_own_takes_an_effort(monkeypatch: pytest.MonkeyPatch) -> None:
    """The effort of a driver, put in the place of its magnitude, gives the driver's motion."""
    kind = extend.ForceKind(
        "servo",
        lambda force: (extend.Element(extend.TURN, (extend.Term(extend.CONSTANT, force.params.get("moment", 0.0)),)),),
        example=lambda m, i, j: None,
        effort="moment",
    )
    monkeypatch.setitem(FORCE_KINDS, "servo", kind)
    m = pendulum(KINDS["revolute"])
    params, laws = extend.amount_given(m, "s", "moment", 1.0)
    extend.add_force(m, kind, "s", m.ground.origin, m.bodies["rod"].origin, params, laws, same_body=True)
    assert m.with_efforts(s=2.5).forces["s"].params == {"moment": 2.5}
    m.spring("spring", m.ground.at(1.0, 0.0), m.bodies["rod"].end, 10.0)
    with pytest.raises(ModelError, match="force 'spring' is a spring; only drivers, torques, forces and actuators"):
        m.with_efforts(spring=1.0)


def maltese(**own) -> extend.JointKind:
    """A Geneva whose argument has another name."""
    numbers = {"numbers": lambda params: [(params["stations"], params["radius"])], "problem": None}
    return replace(KINDS["geneva"], name="maltese", **numbers, **own)


def test_a_wheel_that_looks_alike_after_a_turn_has_no_other_way_to_close() -> None:
    def told(kind: extend.JointKind) -> list[str]:
        m = geneva(4, start=1.0)
        index = m.joints.pop("index")
        extend.join(m, kind, "index", index.i, index.j, None, stations=4, radius=index.params["radius"])
        m.start_near(wheel=0.0)
        return [finding.name for finding in m.check()]

    assert told(maltese(symmetry=None)) == ["wheel"]
    assert told(maltese(symmetry=lambda params: params["stations"])) == []


def test_a_wrong_symmetry_is_found() -> None:
    def wheel(m, i: extend.Marker, j: extend.Marker):
        return extend.join(m, wrong, "example", i, j, None, stations=5, radius=0.3)

    wrong = maltese(example=wheel, symmetry=lambda params: 4)
    with pytest.raises(AssertionError, match=r"maltese, seed 0: Phi after a turn of body j by 1/4, row 0 \(geneva\)"):
        check_joint(wrong)


def test_a_place_of_contact_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ValueError, match="touching is 'rim'; it must be one of line, curve, discs, place, or empty"):
        extend.register_joint(extend.JointKind("odd", ("point",), example=lambda m, i, j: None, touching="rim"))


def test_the_solver_compares_no_name_of_a_kind() -> None:
    """Names are for registries, files and messages; drawing has its signs by name (``drawn_as``)."""
    compared = re.compile(r"""kind\.name\s*(==|!=|in|not in)\s*[("'\[{]""")
    files = [*(ROOT / "mbsd").rglob("*.py"), *(ROOT / "mechanisms" / "stages" / "solve").glob("*.py")]
    offenders = {file.name for file in files if compared.search(file.read_text())}
    assert not offenders
