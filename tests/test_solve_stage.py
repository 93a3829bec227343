"""Masses from parts to model, what is refused, and the motion as the contract has it."""

from __future__ import annotations

import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.solve_stage import apply_masses, to_motion
from shared import contract
from shared.errors import UserError


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
    apply_masses(m, parts)
    assert (m.bodies["arm"].mass, m.bodies["arm"].com, m.bodies["arm"].inertia) == (0.3, (0.11, 0.01), 2e-4)
    motion = to_motion(m.sweep(steps=8), parts, "key", {"numpy": "2"})
    arm = motion.bodies["arm"]
    assert (arm.mass, arm.com, arm.inertia, arm.z) == (0.3, (0.11, 0.01), 2e-4, 0.005)
    assert motion.period == pytest.approx(2 * 3.141592653589793 / 6.0)
    assert motion.joints["A"].bodies == ("ground", "arm")
    assert motion.drivers["motor"].kind == "angle"
    assert set(motion.points) == {"tip"}
    assert max(motion.drivers["motor"].effort) > 0.2


def test_names_that_differ_are_told() -> None:
    with pytest.raises(UserError, match=r"arm: parts\.py has no body 'arm'; it has: lever"):
        apply_masses(_mechanism(), _parts("ground", "lever"))
    with pytest.raises(UserError, match=r"arm: mechanism\.py has no body 'lever'"):
        apply_masses(_mechanism(), _parts("ground", "arm", "lever"))
