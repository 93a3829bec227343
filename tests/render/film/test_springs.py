"""Springs, cylinders and ropes of films: geometry between points and bodies that move; no Blender."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from render.blender.scene.tubes import SIDES
from render.blender.scene.tubes import tube_vertices as vertices
from render.film.film import Film
from render.film.framing import project
from render.film.poses import Moment, Poses, moved
from render.film.tubes.spirals import APART, HUB, RIM, Site, Spiral, spirals
from render.film.tubes.stretched import HOOK, cylinder_tubes, helix, placed, sagging
from render.frames.keys import scene_key
from render.presets import PRESETS
from shared.contract import Action, ContactMotion, ForceMotion, Motion, Shape, read_motion, read_parts
from shared.contract.shot import Shot, read_shot
from tests.render.planar import in_plane
from tools.fixtures import film_fixture
from tools.models.motions import four_bar_motion

A = np.array([0.1, -0.2, 0.03])
DOWN = np.array([0.0, -1.0, 0.0])
MARKERS = ((0.05, 0.2, 0.0), (0.03, 0.01, 0.0))


def force(motion: Motion, stiff: bool) -> ForceMotion:
    """A spring from a point of ground to one of the rocker, or a damper if it holds no energy."""
    rocker = motion.bodies["rocker"]
    end = np.array([placed(pose, MARKERS[1]) for pose in zip(rocker.x, rocker.y, rocker.theta, strict=True)])
    value = np.hypot(*(end - MARKERS[0][:2]).T)
    zero = np.zeros(len(value)).tolist()
    return ForceMotion(
        kind="spring",
        actions=[Action(body="rocker", x=end[:, 0].tolist(), y=end[:, 1].tolist(), fx=zero, fy=zero, torque=zero)],
        several=False, measures="length", value=value.tolist(), rate=zero, effort=zero, normal=None, power=zero,
        potential=[float(stiff)] * len(value), shape=Shape(bodies=("ground", "rocker"), markers=MARKERS),
        look="coil" if stiff else "cylinder",
    )  # fmt: skip


def film(stiff: bool = True, rope: float | None = None) -> Film:
    out = film_fixture.write(Shot(seconds_per_turn=0.4))
    motion = read_motion(out.motion)
    zero = np.zeros(len(motion.time)).tolist()
    shape = Shape(bodies=("ground", "rocker"), markers=MARKERS, length=rope)
    contact = ContactMotion(
        kind="rope", bodies=("ground", "rocker"), x=zero, y=zero, fx=zero, fy=zero, torque=zero, gap=zero, rate=zero,
        normal=zero, friction=zero, state=["open"] * len(zero), shape=shape, look="cord",
    )  # fmt: skip
    motion = msgspec.structs.replace(
        motion, forces={"spring": force(motion, stiff)}, contacts={} if rope is None else {"rope": contact}
    )
    return Film(motion, read_parts(out.parts), read_shot(out.shot), out.parts_folder)


@pytest.mark.parametrize("length", [0.05, 0.11, 0.3])
def test_a_coil_keeps_its_turns_and_its_radius_however_long_it_is(length: float):
    direction = np.array([0.6, 0.8, 0.0])
    b, turns, radius = A + length * direction, 7, 0.008
    path = helix(A, b, radius, turns)
    assert path[0] == pytest.approx(A)
    assert path[-1] == pytest.approx(b)
    assert len(path) == len(helix(A, A + direction, radius, turns))
    along = (path - A) @ direction
    off = path - A - along[:, None] * direction
    distance = np.linalg.norm(off, axis=1)
    inside = (along > length * (HOOK + (1 - 2 * HOOK) / (turns + 2))) & (along < length * (1 - HOOK) * 0.98)
    inside &= along < length - length * (HOOK + (1 - 2 * HOOK) / (turns + 2))
    assert distance[inside] == pytest.approx(radius)
    assert distance.max() < radius * (1 + 1e-9)
    side = np.array([-0.8, 0.6, 0.0])
    angle = np.unwrap(np.arctan2(off[inside] @ np.array([0.0, 0.0, 1.0]), off[inside] @ side))
    assert abs(angle[-1] - angle[0]) / (2 * np.pi) == pytest.approx(turns, abs=0.2)
    assert (np.diff(along) > 0).all()


@pytest.mark.parametrize("distance", [0.02, 0.2, 0.399])
def test_a_slack_rope_has_its_length_and_hangs_down(distance: float):
    b = A + distance * np.array([1.0, 0.0, 0.0])
    path = sagging(A, b, 0.4, DOWN)
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).sum() == pytest.approx(0.4, rel=1e-9)
    assert path[1:-1, 1].max() < A[1]
    assert path[[0, -1]] == pytest.approx(np.array([A, b]))


def test_a_taut_rope_and_one_without_weight_are_straight():
    b = A + np.array([0.4, 0.0, 0.0])
    for path in (sagging(A, b, 0.4, DOWN), sagging(A, b, 0.6, np.zeros(3))):
        assert path[:, 1:] == pytest.approx(np.tile(A[1:], (len(path), 1)))


def test_a_tube_has_its_radius_everywhere():
    path = helix(A, A + np.array([0.1, 0.0, 0.0]), 0.01, 5)
    rings = vertices([(float(x), float(y), float(z)) for x, y, z in path], 0.002).reshape(-1, SIDES, 3)
    assert np.linalg.norm(rings - path[:, None], axis=2) == pytest.approx(0.002, rel=1e-3)
    assert rings.mean(axis=1) == pytest.approx(path, abs=1e-6)


def test_the_spring_follows_its_bodies_in_every_frame(out_root: Path):
    seen = film()
    for frame in (0, 4, 9):
        state, at = seen.state(frame), seen.clock.moment(frame)
        coil = np.array(state.tubes[0])
        assert coil[0, :2] == pytest.approx(MARKERS[0][:2])
        assert coil[-1, :2] == pytest.approx(placed(in_plane(state.bodies["rocker"]), MARKERS[1]))
        assert [len(path) for path in state.tubes] == [spec.points for spec in seen.scene.tubes]
        assert at.time == pytest.approx(frame / 12)
    height = coil[0, 2]
    top = max(piece.z_range[1] for piece in seen.parts.bodies["rocker"].pieces.values())
    assert height > film_fixture.LAYERS["rocker"]
    assert height < top + seen.space.size


def test_without_stiffness_a_rod_slides_in_a_cylinder_and_stays_in_it(out_root: Path):
    seen = film(stiff=False)
    names = [spec.name for spec in seen.scene.tubes[:3]]
    assert names == ["spring cylinder", "spring rod", "spring eye"]
    lengths = []
    for frame in range(seen.clock.frames):
        cylinder, rod, eye = (np.array(path) for path in seen.state(frame).tubes[:3])
        lengths += [np.linalg.norm(np.diff(tube, axis=0)) for tube in (cylinder, rod)]
        axis = (rod[0] - eye[0]) / np.linalg.norm(rod[0] - eye[0])
        assert 0 < (rod[1] - eye[0]) @ axis < (cylinder[1] - eye[0]) @ axis
        assert (rod[0] - cylinder[1]) @ axis > 0
    assert np.ptp(lengths[::2]) < 1e-9
    assert np.ptp(lengths[1::2]) < 1e-9


@pytest.mark.parametrize("part", [1.0, 1.2, 1.5, 1.58, 1.6, 1.8, 1.9, 3.0, 7.5])
def test_rods_reach_into_their_cylinder_however_far_it_goes_out(part: float):
    least = 0.1
    tubes = {spec.name: path for spec, path in cylinder_tubes("ram", 0.01, least, part * least)}
    rods = [path for name, path in tubes.items() if "rod" in name or "stage" in name]
    assert len(rods) == max(1, int(np.ceil((part - 0.94) / 0.94**2 - 1e-12)))
    for length in np.linspace(least, part * least, 9):
        a, b = np.zeros(3), np.array([length, 0.0, 0.0])
        mouth = tubes["ram cylinder"](a, b)[1][0]
        assert mouth <= length + 1e-12
        for rod in rods:
            out, inside = (point[0] for point in rod(a, b))
            assert 0.0 <= inside < mouth <= out + 1e-12, (length, inside, mouth)
            mouth = out
        assert mouth == pytest.approx(length)


def test_coil_and_rope_count_in_the_key_and_are_in_the_picture(out_root: Path):
    from render.film.framing import project

    keys = {scene_key(filmed.scene, PRESETS["draft"], "5.2") for filmed in (film(), film(False), film(rope=0.4))}
    assert len(keys) == 3
    seen = film(rope=0.6)
    state = seen.state(3)
    assert "rope" in {spec.name for spec in seen.scene.tubes}
    at: Moment = seen.clock.moment(3)
    rope = next(stretched for stretched in seen.stretched if stretched.name == "rope")
    assert np.linalg.norm(np.diff(rope.paths(seen.poses, at)[0], axis=0), axis=1).sum() == pytest.approx(0.6)
    for path in state.tubes:
        pixels = project(state.camera, np.array(path), 1280, 720)
        assert (pixels > 0).all()
        assert (pixels < (1280, 720)).all()


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


def spirals_of(motion: Motion, site: Site | None = SITE) -> list[Spiral]:
    return list(spirals(motion, 0.3, lambda bodies, places, radius: site))


def test_its_ends_stay_on_the_stud_and_at_the_hub_and_it_turns_as_the_bodies_do():
    motion = with_spring(four_bar_motion())
    [spring] = spirals_of(motion)
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
    [spring] = spirals_of(motion)
    for turned in (theta[0], theta[-1]):
        turns = spring.turns - turned / math.tau
        assert turns >= 1.5 - 1e-9
        assert (RIM - HUB) * 0.3 / turns >= 2 * APART * spring.wire * (1 - 1e-9)
    assert spring.points > 30 * max(spring.turns - angle / math.tau for angle in theta)


def test_there_is_none_without_stiffness_without_a_pin_and_without_room():
    motion = four_bar_motion()
    assert spirals_of(with_spring(motion, stiff=False)) == []
    assert spirals_of(with_spring(motion, ("ground", "coupler"))) == []  # no pin holds these two together
    assert spirals_of(with_spring(motion), site=None) == []
    off = with_spring(motion, ("crank", "rocker"))
    assert np.abs(moved(off, "crank", (0.12, 0.0, 0.0))[0] - moved(off, "rocker", (0.0, 0.0, 0.0))[0]).max() > 0.01
    assert spirals_of(off) == []


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
