"""Rollers of films turn as they roll: closed forms of a round cam and a slot, loops without a seam, their poses."""

from __future__ import annotations

import json
import math
import struct
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mechanisms.geneva_drive.mechanism import Params, build
from mechanisms.stages.solve.motion_file import to_motion
from render.film.film import Film
from render.film.rollers import turned
from render.glb.build import glb
from shared.contract import (
    BodyMotion,
    ContactMotion,
    JointMotion,
    Motion,
    Rolling,
    Shape,
    read_motion,
    read_parts,
    write_parts,
)
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from tests.render.planar import in_plane
from tools.fixtures import film_fixture
from tools.models.motions import bouncing_ball

TIME = np.linspace(0.0, 2.0, 201)
ZERO = np.zeros_like(TIME)


def body(x: np.ndarray, y: np.ndarray, theta: np.ndarray) -> BodyMotion:
    """A body whose rates are differences."""
    rates = {f"v{k}": np.gradient(v, TIME, edge_order=2).tolist() for k, v in (("x", x), ("y", y))}
    return BodyMotion(
        x=x.tolist(), y=y.tolist(), theta=theta.tolist(), **rates,
        omega=np.gradient(theta, TIME, edge_order=2).tolist(), ax=ZERO.tolist(), ay=ZERO.tolist(),
        alpha=ZERO.tolist(), z=0.0, mass=1.0, com=(0.0, 0.0), inertia=1.0,
    )  # fmt: skip


def motion(bodies: dict[str, BodyMotion], joint: JointMotion, period: float | None = None) -> Motion:
    """Two bodies and a joint called contact."""
    return msgspec.structs.replace(
        bouncing_ball(), time=TIME.tolist(), bodies=bodies, joints={"contact": joint}, points={}, events=[],
        period=period,
    )  # fmt: skip


def joint(look: str, bodies: tuple[str, str], fy: np.ndarray = ZERO, **shape: Any) -> JointMotion:
    markers = shape.pop("markers", ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    series = {name: ZERO.tolist() for name in ("x", "y", "fx", "torque")}
    told = Shape(bodies=bodies, markers=markers, **shape)
    return JointMotion(kind="any", bodies=bodies, **series, fy=fy.tolist(), look=look, shape=told)  # pyright: ignore[reportArgumentType]


def rolling(radius: float, marks: int = 6, x: float = 0.0) -> Rolling:
    return Rolling(joint="contact", x=x, y=0.0, radius=radius, marks=marks)


def round_cam(speed: float, cam: float, roller: float, arm: float, period: float | None = None) -> Motion:
    """A round cam about the origin, and a roller beside it that stands, on a follower whose frame is elsewhere."""
    turn = np.linspace(0, 2 * np.pi, 240, endpoint=False)
    outline = [(float(x), float(y)) for x, y in cam * np.stack([np.cos(turn), np.sin(turn)], axis=1)]
    bodies = {"cam": body(ZERO, ZERO, speed * TIME), "follower": body(cam + roller + arm + ZERO, ZERO, ZERO)}
    contact = joint("roller", ("cam", "follower"), outline=outline, outline_closed=True)
    return motion(bodies, contact, period)


@given(st.floats(-3, 3), st.floats(0.01, 0.1), st.floats(0.2, 2.0))
def test_a_round_cam_turns_its_roller_by_the_ratio_of_their_radii(speed: float, cam: float, ratio: float):
    made = turned(round_cam(speed, cam, ratio * cam, 0.05), "follower", rolling(ratio * cam, x=-0.05))
    assert made == pytest.approx(-speed * TIME / ratio, abs=1e-3 * abs(speed) / ratio + 1e-9)


def test_a_roller_that_goes_round_with_its_arm_turns_against_it():
    """A cam at rest, an arm that turns with the roller at its end: as a planet round a fixed sun, 1 + R / r turns."""
    made = turned(
        motion(
            {"cam": body(ZERO, ZERO, ZERO), "follower": body(ZERO, ZERO, 1.5 * TIME)},
            joint(
                "roller", ("cam", "follower"), outline_closed=True,
                outline=[(0.04 * math.cos(a), 0.04 * math.sin(a)) for a in np.linspace(0, math.tau, 721)[:-1]],
            ),
        ),
        "follower", rolling(0.02, x=0.06),
    )  # fmt: skip
    assert made == pytest.approx(2.0 * 1.5 * TIME, abs=5e-3)  # against the arm: R / r times as fast


def test_in_a_slot_it_rolls_on_the_wall_that_pushes_it():
    x = 0.03 * TIME
    push = np.where(TIME < 1.0, 5.0, -5.0)  # on the roller: from below, then from above
    bodies = ("ground", "slider")
    contact = joint("captive", bodies, fy=push)
    made = turned(motion({"slider": body(x, ZERO, ZERO)}, contact), "slider", rolling(0.01))
    rate = np.gradient(made, TIME)
    assert rate[5:95] == pytest.approx(-3.0)  # like a wheel on a floor
    assert rate[105:195] == pytest.approx(3.0)
    late = joint("captive", bodies, fy=np.where(TIME < 1.0, 0.0, push))
    waits = np.gradient(turned(motion({"slider": body(x, ZERO, ZERO)}, late), "slider", rolling(0.01)), TIME)
    assert not waits[:95].any()  # no reaction yet: nothing tells a wall
    assert waits[105:195] == pytest.approx(3.0)


def test_without_a_reaction_a_roller_rests_on_its_body():
    for look, shape in (("captive", {}), ("captive", {"slots": 4, "pin_radius": 0.03}), ("", {})):
        idle = joint(look, ("ground", "slider"), **shape)
        assert not turned(motion({"slider": body(0.03 * TIME, ZERO, TIME)}, idle), "slider", rolling(0.01)).any()


@given(st.floats(0.1, 0.5), st.sampled_from([-1.0, 1.0]))
def test_on_a_bent_slot_it_rolls_on_the_side_that_pushes_it(speed: float, side: float):
    """A pin on an arm runs in a circular slot of ground: on its outer wall, or on its inner one."""
    way, roller, turn = 0.05, 0.01, speed * TIME
    circle = [(way * math.cos(a), way * math.sin(a)) for a in np.linspace(0, math.tau, 721)[:-1]]
    curve = joint("captive", ("ground", "arm"), outline=circle, outline_closed=True)
    push = msgspec.structs.replace(
        curve, fx=(-side * np.cos(turn)).tolist(), fy=(-side * np.sin(turn)).tolist()
    )  # from the outer wall: towards the middle
    made = turned(motion({"arm": body(ZERO, ZERO, turn)}, push), "arm", rolling(roller, x=way))
    outer = -side * (way + side * roller) / roller
    assert made == pytest.approx((outer - 0.0) * turn, abs=2e-2 * speed)


def test_a_geneva_pin_rolls_on_the_flank_it_pushes_and_rests_while_the_wheel_is_locked():
    m = build(Params())
    for part in (m.bodies["crank"], m.bodies["wheel"]):
        part.mass, part.inertia = 1.0, 1e-3
    seen = to_motion(m.sweep(steps=1440), None, "", {}, {})
    told, crank, wheel = seen.joints["index"], seen.bodies["crank"], seen.bodies["wheel"]
    assert told.shape is not None
    radius, roller = told.shape.pin_radius, 0.008
    assert radius is not None
    made = turned(seen, "crank", Rolling(joint="index", x=radius, y=0.0, radius=roller, marks=720))
    turn, time = np.asarray(crank.theta), np.asarray(seen.time)
    rate, late = np.gradient(made, time), np.cos(turn) - math.cos(math.pi / 4)  # above zero while the pin is in a slot
    assert np.abs(rate[late < -5e-2]).max() < 1e-9
    slides = np.gradient(np.hypot(radius * np.cos(turn) - Params().distance, radius * np.sin(turn)), time)
    flank = np.sign(told.torque)  # 1: the pin pushes to its left, seen from the wheel
    expected = flank * slides / roller + np.asarray(wheel.omega) - np.asarray(crank.omega)
    inner = (late > 5e-2) & (np.gradient(flank) == 0)
    assert inner.sum() > 120
    assert rate[inner] == pytest.approx(expected[inner], abs=1e-2 * np.abs(expected).max())


def test_a_roller_that_has_left_its_cam_turns_on():
    """A round cam under a roller that stands still: they touch from 0.5 s to 1 s."""
    seen = round_cam(2.0, 0.04, 0.02, 0.0)
    state = ["closed" if 0.5 <= t <= 1.0 else "open" for t in TIME]
    was = seen.joints["contact"]
    assert was.shape is not None
    series = {name: ZERO.tolist() for name in ("x", "y", "fx", "fy", "torque", "gap", "rate", "normal", "friction")}
    touch = ContactMotion(kind="rigid_terrain", bodies=was.bodies, state=state, shape=was.shape, **series)  # pyright: ignore[reportArgumentType]
    free = msgspec.structs.replace(seen, joints={}, contacts={"contact": touch})
    rate = np.gradient(turned(free, "follower", rolling(0.02)), TIME)
    assert not rate[:48].any()
    assert rate[52:98] == pytest.approx(-4.0, rel=1e-3)
    assert rate[102:] == pytest.approx(-4.0, rel=1e-3)


def test_a_period_ends_with_the_roller_as_it_was_and_other_joints_turn_nothing():
    made = turned(round_cam(1.0, 0.04, 0.03, 0.0, period=2.0), "follower", rolling(0.03, 5))
    assert made[-1] / (2 * np.pi / 5) == pytest.approx(round(made[-1] / (2 * np.pi / 5)))
    assert made[-1] == pytest.approx(-2.0 * 4 / 3, abs=np.pi / 5)
    still = motion({"slider": body(ZERO, ZERO, TIME)}, joint("revolute", ("ground", "slider")))
    assert not turned(still, "slider", rolling(0.01)).any()
    assert not turned(still, "slider", msgspec.structs.replace(rolling(0.01), joint="gone")).any()


@pytest.fixture
def film(out_root: Path) -> Film:
    """The four-bar; the ball at the end of its coupler rolls in a slot of ground along x through D."""
    out = film_fixture.write()
    seen, parts = read_motion(out.motion), read_parts(out.parts)
    slot = msgspec.structs.replace(
        seen.joints["C"], look="captive", bodies=("ground", "coupler"),
        shape=Shape(bodies=("ground", "coupler"), markers=((0.12, 0.0, 0.0), (0.12, 0.0, 0.0))),
    )  # fmt: skip
    parts.bodies["coupler"].pieces["end"].rolls = Rolling(joint="C", x=0.12, y=0.0, radius=0.01, marks=4)
    write_parts(out.parts, parts)
    return Film(msgspec.structs.replace(seen, joints=seen.joints | {"C": slot}), parts, Shot(), out.parts_folder)


def test_the_roller_has_a_pose_of_its_own_about_its_axis(film: Film):
    [spec] = [piece for piece in film.scene.pieces if piece.turns_about is not None]
    assert (spec.body, spec.name, spec.turns_about) == ("coupler", "end", (0.12, 0.0))
    state = film.state(17)
    x, y, theta = in_plane(state.bodies["coupler"])
    u, v, angle = in_plane(state.bodies["coupler/end"])
    assert (u, v) == pytest.approx((x + 0.12 * math.cos(theta), y + 0.12 * math.sin(theta)))
    assert angle != pytest.approx(theta)
    assert film.state(17 + film.clock.frames).bodies["coupler/end"] == state.bodies["coupler/end"]


def test_in_the_glb_it_turns_about_its_axis_below_its_body(film: Film):
    content = glb(film)
    size = struct.unpack_from("<I", content, 12)[0]
    document = json.loads(content[20 : 20 + size])
    nodes = document["nodes"]
    number = next(k for k, node in enumerate(nodes) if node["name"] == "coupler/end")
    coupler = next(node for node in nodes if node["name"] == "coupler")
    assert number in coupler["children"]
    assert nodes[number]["translation"] == pytest.approx([0.12, 0.0, 0.0])
    [channel] = [c for c in document["animations"][0]["channels"] if c["target"]["node"] == number]
    assert channel["target"]["path"] == "rotation"
    positions = document["accessors"][
        document["meshes"][nodes[number]["mesh"]]["primitives"][0]["attributes"]["POSITION"]
    ]
    assert np.add(positions["min"], positions["max"])[:2] == pytest.approx([0.0, 0.0], abs=1e-6)


def test_a_roller_in_a_joint_that_is_not_there_is_refused(film: Film):
    rolls = film.parts.bodies["coupler"].pieces["end"].rolls
    assert rolls is not None
    film.parts.bodies["coupler"].pieces["end"].rolls = msgspec.structs.replace(rolls, joint="c")
    with pytest.raises(UserError, match=r"coupler/end rolls in joint 'c', which data.json has not; it has: A, B, C, D"):
        Film(film.motion, film.parts, Shot(), film.folder)
