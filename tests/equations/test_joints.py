"""Every joint and driver on random paths, by central differences; and errors that this check must find."""

from __future__ import annotations

import numpy as np
import pytest

import mbsd.testing.joints
from mbsd import Mechanism, harmonic
from mbsd.arrays.packing import pack
from mbsd.equations.assembly import tabulate, tabulate_all, tabulate_some
from mbsd.model.body import Marker
from mbsd.model.entries import join
from mbsd.model.joint import KINDS, JointKind, register_joint
from mbsd.testing import check_joint, joint_kinds


def test_each_kind_is_a_method() -> None:
    for kind in joint_kinds():
        assert callable(getattr(Mechanism, kind.name)), kind.name


@pytest.mark.parametrize("kind", joint_kinds(), ids=lambda kind: kind.name)
def test_equations_agree_with_differences(kind: JointKind) -> None:
    check_joint(kind)


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("phi", r"revolute, seed 0: J against dPhi/dq, row 1 \(point\), theta of 'first'"),
        ("jacobians", r"revolute, seed 0: J against dPhi/dq, row 1 \(point\), theta of 'first'"),
        ("gamma", r"revolute, seed 0: J a - gamma against d\(J v - nu\)/dt, row 1 \(point\)"),
    ],
)
def test_a_wrong_equation_is_found(table: str, says: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors of a thousandth in one term."""

    def wrong(system, drives, q, v, ws, phi, jacobians, gamma):
        tabulate(system, drives, q, v, ws, phi, jacobians, gamma)
        if table == "phi":
            phi[:, 1] += 1e-3 * np.sin(q[:, 5])
        elif table == "jacobians":
            jacobians[:, 1, 2] += 1e-3
        else:
            gamma[:, 1] *= 1.001

    monkeypatch.setattr(mbsd.testing.joints, "tabulate", wrong)
    with pytest.raises(AssertionError, match=says):
        check_joint(KINDS["revolute"])


def test_without_slots_and_distances_the_rows_are_the_same() -> None:
    m = Mechanism("gears")
    pinion, gear, plate = (m.body(name) for name in ("one", "other", "plate"))
    m.revolute("A", m.ground.at(0, 0), pinion.origin)
    m.revolute("B", m.ground.at(0.3, 0), gear.origin)
    m.gear_pair("teeth", pinion.origin, gear.origin, 20, 40)
    m.weld("plate", gear.at(0.1, 0.2), plate.origin)
    m.drive_angle("motor", pinion, harmonic(0.3, 1.7, 0.2, 0.9))
    m.start_near(one=10, other=20, plate=(0.3, 0.1, 20))
    packed, times = pack(m), np.linspace(0.0, 1.0, 5)
    packed.settle_laws(0.0, 1.0)
    q, v = np.random.default_rng(1).standard_normal((2, len(times), len(packed.system.mass) * 3))
    tables = []
    for each in (tabulate_some, tabulate_all, tabulate):
        phi, gamma = np.zeros((2, len(times), len(packed.ws.phi)))
        jacobians = np.zeros((*phi.shape, 6))
        each(packed.system, packed.drives(times), q, v, packed.ws, phi, jacobians, gamma)
        tables.append((phi, jacobians, gamma))
    for some, general, chosen in zip(*tables, strict=True):
        assert (some == general).all()
        assert (some == chosen).all()
        assert some.any()


def test_a_driver_whose_rate_is_wrong_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mbsd.testing.joints, "fill_nu", lambda system, drive, nu: None)
    with pytest.raises(AssertionError, match=r"drive_angle, seed 0: J v - nu against dPhi/dt, row 0 \(angle\)"):
        check_joint(KINDS["drive_angle"])


def test_a_kind_that_loses_its_arguments_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its params have another name than the argument of the function that adds one."""
    monkeypatch.setattr("mbsd.model.joint.KINDS", dict(KINDS))
    kind = register_joint(JointKind("arm", ("distance",), example=lambda m, i, j: arm(m, "example", i, j, 0.7)))

    @kind.adds
    def arm(m, name: str, i: Marker, j: Marker, reach: float):
        return join(m, kind, name, i, j, length=reach)

    with pytest.raises(AssertionError, match=r"arm: params hold 'length', with which change.. fails: .*'length'"):
        check_joint(kind)
    other = register_joint(JointKind("other", ("distance",), example=KINDS["revolute"].example))
    with pytest.raises(AssertionError, match="other: its example must add one 'other' and nothing else"):
        check_joint(other)
    bare = register_joint(JointKind("bare", ("point",), example=lambda m, i, j: join(m, bare, "example", i, j)))
    with pytest.raises(AssertionError, match=r"bare: decorate the function that adds one with @BARE.adds"):
        check_joint(bare)


def test_a_kind_without_an_example_is_refused() -> None:
    with pytest.raises(ValueError, match="example is missing"):
        register_joint(JointKind("bare", ("point",), example=None))  # pyright: ignore[reportArgumentType]
    with pytest.raises(ValueError, match="constraints"):
        register_joint(JointKind("odd", ("nothing",), example=lambda m, i, j: None))
    with pytest.raises(ValueError, match="registered twice"):
        register_joint(KINDS["revolute"])
