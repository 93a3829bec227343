"""Torsion springs of films: a spiral whose ends stay fixed to their bodies while it winds up and unwinds."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from render.blender.scene.tubes import tube_vertices as vertices
from render.film.film import Film
from render.film.framing import project
from render.film.poses import Moment, Poses, moved
from render.film.tubes.spirals import APART, HUB, RIM, Site, Spiral, spirals
from shared.contract import Action, ForceMotion, Motion, Shape, read_motion, read_parts
from shared.contract.shot import Shot
from tools.fixtures import film_fixture
from tools.models.motions import four_bar_motion

PIN = np.array([0.12, 0.0])
SITE = Site(outer="rocker", direction=0.4, base=0.02, hub=0.025, over=0.03)


def with_spring(motion: Motion, bodies: tuple[str, str] = ("ground", "rocker"), stiff: bool = True) -> Motion:
    """A torsion spring about D, or a damper if it holds no energy."""
    zero = [0.0] * len(motion.time)
    shape = Shape(bodies=bodies, markers=((0.12, 0.0, 0.0), (0.0, 0.0, 0.0)))
    acts = [Action(body=body, x=zero, y=zero, fx=zero, fy=zero, torque=zero) for body in bodies]
    force = ForceMotion(
        kind="torsion_spring", actions=acts, several=False, measures="angle", value=zero, rate=zero, effort=zero,
        normal=None, power=zero, potential=[0.1 if stiff else 0.0] * len(zero), shape=shape,
        look="spiral" if stiff else "",
    )  # fmt: skip
    return msgspec.structs.replace(motion, forces={"spring": force})


def made(motion: Motion, site: Site | None = SITE) -> list[Spiral]:
    return list(spirals(motion, 0.3, lambda bodies, places, radius: site))


def test_its_ends_stay_on_the_stud_and_at_the_hub_and_it_turns_as_the_bodies_do():
    motion = with_spring(four_bar_motion())
    [spring] = made(motion)
    poses = Poses(motion)
    for time in (0.0, 0.31, 0.77):
        at = Moment(time, 0)
        wire, hub, stud = (np.array(path) for path in spring.paths(poses, at))
        theta = poses.body("rocker", at)[2]
        rim = RIM * 0.3 * np.array([math.cos(theta + 0.4), math.sin(theta + 0.4)])
        assert wire[0, :2] == pytest.approx(PIN + rim)
        assert stud[:, :2] == pytest.approx(np.tile(PIN + rim, (2, 1)))
        assert stud[0, 2] == SITE.base
        assert wire[0, 2] < stud[1, 2]
        assert hub[:, :2] == pytest.approx(np.tile([0.12, 0.0], (2, 1)))
        assert np.hypot(*(wire[-1, :2] - [0.12, 0.0])) == pytest.approx(HUB * 0.3)
        angle = np.unwrap(np.arctan2(wire[:, 1], wire[:, 0] - 0.12))
        inner = angle[-1] % math.tau
        first = np.array(spring.paths(poses, Moment(0.0, 0))[0])[-1, :2] - [0.12, 0.0]
        assert inner == pytest.approx(math.atan2(first[1], first[0]) % math.tau)  # the ground does not turn
        assert (angle[-1] - angle[0]) / math.tau == pytest.approx(spring.turns - theta / math.tau)


@given(st.floats(-40.0, 40.0), st.floats(0.0, 30.0))
@settings(max_examples=40)
def test_its_turns_never_touch_however_far_it_is_wound(start: float, swing: float):
    motion = with_spring(four_bar_motion(steps=36))
    theta = start + swing * np.linspace(0, 1, len(motion.time))
    rocker = msgspec.structs.replace(motion.bodies["rocker"], theta=theta.tolist())
    motion = msgspec.structs.replace(motion, bodies=motion.bodies | {"rocker": rocker})
    [spring] = made(motion)
    for turned in (theta[0], theta[-1]):
        turns = spring.turns - turned / math.tau
        assert turns >= 1.5 - 1e-9
        assert (RIM - HUB) * 0.3 / turns >= 2 * APART * spring.wire * (1 - 1e-9)
    assert spring.points > 30 * max(spring.turns - angle / math.tau for angle in theta)


def test_there_is_none_without_stiffness_without_a_pin_and_without_room():
    motion = four_bar_motion()
    assert made(with_spring(motion, stiff=False)) == []
    assert made(with_spring(motion, ("ground", "coupler"))) == []  # no pin holds these two together
    assert made(with_spring(motion), site=None) == []
    off = with_spring(motion, ("crank", "rocker"))
    assert np.abs(moved(off, "crank", (0.12, 0.0, 0.0))[0] - moved(off, "rocker", (0.0, 0.0, 0.0))[0]).max() > 0.01
    assert made(off) == []


def test_in_a_film_it_lies_over_all_that_passes_and_in_the_picture(out_root: Path):
    out = film_fixture.write()
    film = Film(with_spring(read_motion(out.motion)), read_parts(out.parts), Shot(), out.parts_folder)
    [spring] = film.spirals
    assert spring.outer == "rocker"
    assert spring.site.direction == pytest.approx(0.0)  # along the rocker, where it is solid
    tops = [piece.z_range[1] for piece in film.parts.bodies["rocker"].pieces.values()]
    assert spring.site.hub == pytest.approx(max(tops))  # the ball at its start
    assert spring.z > max(tops)
    assert {"spring", "spring hub", "spring stud"} <= {spec.name for spec in film.scene.tubes}
    for frame in (0, 40, 90):
        state = film.state(frame)
        for spec, path in zip(film.scene.tubes, state.tubes, strict=True):
            assert len(path) == spec.points
            assert np.isfinite(vertices(path, spec.radius)).all()
            pixels = project(state.camera, np.array(path), 1280, 720)
            assert ((pixels > 0) & (pixels < (1280, 720))).all()
