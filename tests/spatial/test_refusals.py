"""Errors of models in space: each has a sentence and a remedy."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.base.errors import AssemblyError, MobilityError, ModelError, SingularPoseError
from mbsd.spatial import Mechanism, constant_rate, polynomial
from tests.spatial import machines


def two_bodies() -> tuple:
    m = Mechanism("two bodies")
    return m, m.rod("a", (0, 0, 0), (1, 0, 0), mass=1.0), m.rod("b", (1, 0, 0), (1, 1, 0), mass=1.0)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda m, a, b: m.body("c", orientation=(0, 0, 0, 0)), "quaternion of length 0.*1, 0, 0, 0"),
        (lambda m, a, b: m.body("c", com=(0, math.nan, 0)), "must be finite"),
        (lambda m, a, b: m.body("c", com=(0, 1)), "three numbers"),
        (lambda m, a, b: m.body("c", -1.0), "cannot be negative"),
        (lambda m, a, b: m.body("c", 1.0, inertia=(1, 1, 3)), "none exceeds the sum"),
        (lambda m, a, b: m.body("c", 1.0, inertia=(1, 1, -1)), "none can be negative"),
        (lambda m, a, b: m.body("c", 1.0, inertia=(1, 1)), "symmetric 3 x 3"),
        (lambda m, a, b: m.body("a"), "two of the name 'a'"),
        (lambda m, a, b: m.rod("c", (0, 0, 0), (0, 0, 0)), "starts where it ends"),
        (lambda m, a, b: m.revolute("j", a, b, at=(1, 0, 0)), "needs an axis"),
        (lambda m, a, b: m.revolute("j", a, b, axis=(1, 0, 0)), "needs a place"),
        (lambda m, a, b: m.revolute("j", a, b, at=(1, 0, 0), axis=(0, 0, 0)), "needs a length above zero"),
        (lambda m, a, b: m.revolute("j", a, b, at=(1, 0, 0), axis=(0, math.inf, 0)), "must be finite"),
        (lambda m, a, b: m.revolute("j", a, a, at=(1, 0, 0), axis=(0, 0, 1)), "connects 'a' with itself"),
        (lambda m, a, b: m.revolute("j", a, "bb", at=(1, 0, 0), axis=(0, 0, 1)), "no body 'bb', did you mean 'b'"),
        (lambda m, a, b: m.prismatic("j", a, b, at=(1, 0, 0), axis=(0, 0, 1), across=(0, 0, 2)), "are parallel"),
        (
            lambda m, a, b: m.universal("j", a, b, at=(1, 0, 0), first=(1, 0, 0), second=(1, 1, 0)),
            r"at 45 degrees; they must be at 90.*\(0, 1, 0\)",
        ),
        (lambda m, a, b: m.universal("j", a, b, at=(1, 0, 0), first=(1, 0, 0)), "an axis of the cross on each body"),
        (
            lambda m, a, b: m.rod_with_fork("j", a, b, start=(0, 0, 0), end=(1, 1, 0), axis=(1, 0, 0)),
            "at 45 degrees; they must be at 90",
        ),
        (lambda m, a, b: m.distance("j", a, b, start=(1, 0, 0), end=(1, 0, 0)), "use a spherical joint"),
        (lambda m, a, b: m.screw("j", a, b, at=(1, 0, 0), axis=(0, 0, 1), lead=0.0), "lead 0 m"),
        (lambda m, a, b: m.drive_turn("d", "hinge", constant_rate(1.0)), "no joint 'hinge'"),
        (lambda m, a, b: m.gear_pair("g", "hinge", "bearing", teeth=(1, 2)), "no joint 'hinge'"),
        (lambda m, a, b: m.start_near({"hinge": 3}), "no joint 'hinge'"),
        (lambda m, a, b: m.marker, "did you mean|has no attribute"),
    ],
)
def test_a_model_that_cannot_be_is_refused_at_once(wrong, words: str) -> None:
    m, a, b = two_bodies()
    with pytest.raises((ModelError, AttributeError), match=words):
        wrong(m, a, b)


def test_joints_of_a_coupling_must_turn_and_share_a_carrier() -> None:
    m, a, b = two_bodies()
    c = m.rod("c", (0, 0, 0), (0, 0, 1), mass=1.0)
    m.revolute("one", m.ground, a, at=(0, 0, 0), axis=(0, 0, 1))
    m.revolute("other", b, c, at=(0, 0, 0), axis=(0, 0, 1))
    m.spherical("ball", m.ground, b, at=(1, 1, 0))
    with pytest.raises(ModelError, match=r"share no body that carries them.*'one' joins ground and a"):
        m.gear_pair("gears", "one", "other", teeth=(10, 20))
    with pytest.raises(ModelError, match="spherical and has no turn"):
        m.drive_turn("motor", "ball", constant_rate(1.0))
    with pytest.raises(ModelError, match="two whole numbers above zero"):
        m.gear_pair("gears", "one", "other", teeth=(10, 2.5))


def test_bodies_that_float_are_named() -> None:
    m, a, _ = two_bodies()
    m.revolute("hinge", m.ground, a, at=(0, 0, 0), axis=(0, 0, 1))
    m.drive_turn("motor", "hinge", constant_rate(1.0))
    with pytest.raises(MobilityError, match="no joint leads from ground to 'b': it floats"):
        m.sweep()


def test_freedoms_without_a_driver_are_counted() -> None:
    m, a, b = two_bodies()
    m.revolute("hinge", m.ground, a, at=(0, 0, 0), axis=(0, 0, 1))
    m.spherical("ball", a, b, at=(1, 0, 0))
    m.drive_turn("motor", "hinge", constant_rate(1.0))
    with pytest.raises(MobilityError, match="3 of 4 degrees of freedom are not driven: b can still move"):
        m.sweep()


def test_two_drivers_of_one_freedom_are_refused() -> None:
    m = machines.slider_crank()
    m.drive_slide("jack", "rail", constant_rate(0.0))
    with pytest.raises(MobilityError, match="'jack' drives a freedom that the joints and driver 'motor' already fix"):
        m.sweep(duration=1.0)


def test_a_loop_that_does_not_close_is_named_with_its_gap() -> None:
    m = Mechanism("open loop")
    a = m.rod("a", (0, 0, 0), (1, 0, 0), mass=1.0)
    m.revolute("hinge", m.ground, a, at=(0, 0, 0), axis=(0, 0, 1))
    m.distance("rod", m.ground, a, start=(0, 2, 0), end=(1, 0, 0), length=0.9)
    with pytest.raises(AssemblyError, match=r"joint 'rod' stays open by 100 mm at best"):
        m.mobility()


def test_a_redundant_loop_with_short_digits_says_which_joint_opens() -> None:
    """Bennett's loop with axes of four digits: it closes at the start, and not beyond."""
    exact = machines.bennett()
    m = Mechanism("Bennett, four digits")
    links = [m.ground] + [m.body(f"link {k}", 1.0, inertia=(0.1, 0.1, 0.1)) for k in (1, 2, 3)]
    for k, joint in enumerate(exact.joints.values()):
        axis = joint.i.body.rotation @ joint.i.axes[:, 2]
        m.revolute(f"hinge {k}", links[k - 1], links[k], at=joint.i.world_place, axis=np.round(axis, 4))
    m.drive_turn("motor", "hinge 1", constant_rate(1.0))
    with pytest.raises((AssemblyError, MobilityError), match=r"redundant joint 'hinge|already fix"):
        m.sweep()


def test_a_toggle_is_named_with_its_joint_and_time() -> None:
    m = Mechanism("toggle")
    left = m.rod("left", (0, 0, 0), (1, 0, 0), mass=1.0)
    right = m.rod("right", (2, 0, 0), (2, 1, 0), mass=1.0)
    m.revolute("left hinge", m.ground, left, at=(0, 0, 0), axis=(0, 0, 1))
    m.revolute("right hinge", m.ground, right, at=(2, 0, 0), axis=(0, 0, 1))
    m.distance("rod", left, right, start=(1, 0, 0), end=(2, 1, 0))
    m.drive_turn("motor", "left hinge", constant_rate(1.0))
    with pytest.raises(SingularPoseError, match=r"beyond t = .* \(motor at .* degrees\).*'rod'"):
        m.sweep(duration=6.0)


def test_a_leg_that_passes_zero_is_refused() -> None:
    m = Mechanism("leg")
    ball = m.ball("ball", (1, 0, 0), radius=0.1, mass=1.0)
    m.prismatic("rail", m.ground, ball, at=(1, 0, 0), axis=(1, 0, 0))
    m.drive_distance("leg", m.ground, ball, polynomial(1.0, -2.0), start=(0, 0, 0), end=(1, 0, 0))
    with pytest.raises(ModelError, match="must stay positive"):
        m.sweep(duration=1.0)


def test_a_mechanism_without_a_body_is_refused() -> None:
    with pytest.raises(ModelError, match="no body besides ground"):
        Mechanism("empty").mobility()
