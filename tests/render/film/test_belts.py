"""Belts: their path against closed forms, pulleys, their run in the film, and their release."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.wheels.pulleys import Belt as Strands
from mechanisms.stages.automatic.wheels.pulleys import Pulley, sprocket_outline
from mechanisms.stages.solve.motion_file import to_motion
from render.film.poses import Moment, Poses
from render.film.tubes.belts import Belt, belts
from render.glb.document import Animation, Document, Paints
from render.glb.tubes import add_belt
from render.report.travel import releases
from shared.contract import Held, Motion
from shared.contract.geometry import BeltPath
from shared.stage.errors import UserError
from tools.models.outlines import inside

RADII = st.floats(0.01, 0.1)


def drive(
    crossed: bool = False, teeth: tuple[int, int] | None = None, distance: float = 0.12, turn: float = 0.4,
    radii: tuple[float, float] = (0.02, 0.04),
) -> Mechanism:  # fmt: skip
    """Two pulleys on ground, the first driven by a turn a second."""
    m = Mechanism("drive")
    a, b = m.body("a"), m.body("b")
    m.revolute("A", m.ground.at(0.01, 0.02), a.origin)
    m.revolute("B", m.ground.at(0.01 + distance * math.cos(turn), 0.02 + distance * math.sin(turn)), b.origin)
    if teeth:
        m.belt("belt", a.origin, b.origin, teeth=teeth, pitch=2 * math.pi * radii[0] / teeth[0], crossed=crossed)
    else:
        m.belt("belt", a.origin, b.origin, *radii, crossed=crossed)
    m.drive_angle("motor", a, constant_rate(2 * math.pi, 0.3))
    m.start_near(a=17, b=40)
    return m


def filmed(m: Mechanism) -> tuple[Belt, Poses]:
    motion = to_motion(m.sweep(steps=48), None, "", {}, dict.fromkeys(("a", "b"), "mechanism"))
    (belt,) = belts(motion, {"belt": Held(z=0.01, radius=0.001)})
    return belt, Poses(motion)


@given(RADII, RADII, st.floats(0.25, 1.0), st.booleans())
def test_path_is_as_long_as_the_textbook_says_and_runs_at_one_pace(
    first: float, second: float, distance: float, crossed: bool
) -> None:
    """L = 2 d cos(a) + pi (r1 + r2) + 2 a (r1 -+ r2), sin(a) = (r1 -+ r2) / d (Shigley, flat belts: open, crossed)."""
    path = BeltPath(first, second, distance, crossed)
    other = second if crossed else -second
    lean = math.asin((first + other) / distance)
    wanted = 2 * distance * math.cos(lean) + math.pi * (first + second) + 2 * lean * (first + other)
    assert path.length == pytest.approx(wanted)
    s = np.linspace(-0.3, path.length, 4001)
    places, rest = path.places(s)
    pace = np.hypot(*np.diff(places, axis=0).T) / np.diff(s)
    assert pace.max() <= 1 + 1e-9
    assert pace.min() > 1 - 1e-3
    away = np.stack([np.hypot(*places.T) - first, np.hypot(*(places - [distance, 0.0]).T) - second])
    assert away.min() > -1e-12
    assert np.abs(away[:, rest == 0]).min(axis=0).max() < 1e-12
    assert np.abs(rest).max() <= 1


def test_a_place_on_the_second_pulley_has_its_angle() -> None:
    for crossed in (False, True):
        path = BeltPath(0.02, 0.05, 0.2, crossed)
        s = sum(path.parts[:2]) + 0.03
        angle = path.on_second(s)
        place = path.places(np.array([s]))[0][0]
        np.testing.assert_allclose(place, [0.2 + 0.05 * math.cos(angle), 0.05 * math.sin(angle)], atol=1e-15)


@settings(max_examples=6, deadline=None)
@given(st.booleans(), st.floats(-3.0, 3.0))
def test_marks_ride_on_both_pulleys_without_slip(crossed: bool, turn: float) -> None:
    belt, poses = filmed(drive(crossed, turn=turn))
    assert belt.pace == pytest.approx(1.0, abs=0.05)
    step = 1e-3
    before, after = (np.array(belt.paths(poses, Moment(0.3 + k * step, 0))[1:])[:, 2, :2] for k in (0, 1))
    seen = 0
    for body, radius in (("a", 0.02), ("b", 0.04)):
        x, y, theta = poses.body(body, Moment(0.3, 0))
        turned = poses.body(body, Moment(0.3 + step, 0))[2] - theta
        on = np.abs(np.hypot(*(before - [x, y]).T) - radius) < 1e-9
        on &= np.abs(np.hypot(*(after - [x, y]).T) - radius) < 1e-9
        for p, q in zip(before[on] - [x, y], after[on] - [x, y], strict=True):
            way = math.atan2(p[0] * q[1] - p[1] * q[0], p @ q)
            assert way == pytest.approx(belt.pace * turned, rel=1e-3)
            seen += 1
    assert seen > 3


@pytest.mark.parametrize("teeth", [None, (16, 32)])
def test_the_film_loops_without_a_jump(teeth: tuple[int, int] | None) -> None:
    belt, poses = filmed(drive(teeth=teeth))
    first, last = (np.array(belt.paths(poses, at)[-1]) for at in (Moment(0.0, 1), Moment(float(poses.time[-1]), 0)))
    np.testing.assert_allclose(first, last, atol=1e-9)
    begin, end = (
        np.array([path[0] for path in belt.paths(poses, at)[-belt.count :]])
        for at in (Moment(0.0, 0), Moment(float(poses.time[-1]), 0))
    )
    apart = np.linalg.norm(begin[:, None] - end, axis=2)
    assert apart.min(axis=1).max() < 1e-9


def test_rollers_of_a_chain_lie_in_the_seats_of_both_sprockets() -> None:
    radii, teeth = (0.02, 0.04), (16, 32)
    pitch = 2 * math.pi * radii[0] / teeth[0]
    low, high = 0.11, 0.13
    for _ in range(60):  # the distance at which the chain has a whole number of links
        middle = (low + high) / 2
        low, high = (middle, high) if BeltPath(*radii, middle).length < 56 * pitch else (low, middle)
    m = drive(teeth=teeth, distance=low)
    made = Automatic(m, m.sweep(steps=48))
    pulleys = [feature for feature in made.layout.features if isinstance(feature, Pulley)]
    belt, poses = filmed(m)
    assert belt.count == 56
    assert belt.pace == pytest.approx(1.0, abs=1e-9)
    scale = made.sizes.scale * 1e-3
    seen = 0
    for time in (0.0, 0.21, 0.77):
        rollers = np.array([path[0][:2] for path in belt.paths(poses, Moment(time, 0))[: belt.count]])
        for pulley in pulleys:
            x, y, theta = poses.body(pulley.body, Moment(time, 0))
            c, s = math.cos(theta), math.sin(theta)
            local = (rollers - [x, y]) @ np.array([[c, -s], [s, c]])
            on = np.abs(np.hypot(*local.T) - pulley.radius * scale) < 1e-9
            outline = sprocket_outline(pulley.teeth, pulley.radius, pulley.tooth, pulley.phase or 0.0) * scale
            assert not inside(local[on], outline).any()
            miss = np.angle(np.exp(1j * pulley.teeth * (np.arctan2(*local[on].T[::-1]) - (pulley.phase or 0.0))))
            assert np.abs(miss).max() < 1e-6
            seen += int(on.sum())
    assert seen > 60


def test_strands_keep_their_layer_free() -> None:
    """A crank that sweeps the line of centres between two pulleys goes over or under them."""
    m = drive(turn=0.0)
    crank = m.body("crank")
    m.revolute("C", m.ground.at(0.07, 0.02), crank.origin)
    m.revolute("D", crank.at(0.02, 0), m.body("pendulum").origin)
    m.angle_lock("level", m.ground.origin, m.bodies["pendulum"].origin)
    m.drive_angle("other", crank, constant_rate(2 * math.pi))
    made = Automatic(m, m.sweep(steps=48))
    (strands,) = (feature for feature in made.layout.features if isinstance(feature, Strands))
    assert len(list(strands.items(made.layout))) == 2
    assert made.levels["a"] not in (made.levels["crank"], made.levels["pendulum"])


def test_two_belts_on_one_body_have_layers_of_their_own() -> None:
    m = drive(turn=0.0)
    c = m.body("c")
    m.revolute("C", m.ground.at(0.13, 0.16), c.origin)
    m.belt("second", m.bodies["b"].origin, c.origin, 0.03, 0.03)
    made = Automatic(m, m.sweep(steps=24))
    assert made.levels["c"] != made.levels["a"]
    assert {"rim_second_b", "gear_second_b"} <= {solid.name for solid in made.solids(engraved_too=False)["b"]}


def test_a_crank_beside_its_pulley_is_out_of_the_belts_way() -> None:
    m = drive(turn=0.0)
    m.revolute("P", m.bodies["a"].at(0.05, 0), m.body("pendulum").origin)
    m.angle_lock("level", m.ground.origin, m.bodies["pendulum"].origin)
    made = Automatic(m, m.sweep(steps=48))
    pulley = next(feature for feature in made.layout.features if isinstance(feature, Pulley) and feature.body == "a")
    assert made.decided[pulley.layer] == made.levels["b"] != made.levels["a"]


def test_pulleys_that_overlap_are_told() -> None:
    m = drive(distance=0.055)
    with pytest.raises(UserError, match=r"belt 'belt': its pulleys of 20 and 40 mm overlap, .* 55 mm apart"):
        _ = Automatic(m, m.sweep(steps=24)).levels


RELEASE = 0.5


@pytest.fixture(scope="module")
def motion() -> Motion:
    """Two pulleys; the belt slips off after half a second."""
    m = Mechanism("unbelted")
    first, second = m.body("first", 1.0, inertia=0.002), m.body("second", 2.0, inertia=0.004)
    m.revolute("A", m.ground.at(0, 0), first.origin)
    m.revolute("B", m.ground.at(0.25, 0), second.origin)
    belt = m.belt("belt", first.origin, second.origin, 0.04, 0.06)
    m.event("slips off", lambda t, moment: t - RELEASE, releases=[belt])
    m.start_moving(first=6.0)
    return to_motion(m.simulate(1.0, steps=50, event_rows=True), None, "0" * 64, {})


def test_data_json_says_when_a_joint_is_released(motion: Motion) -> None:
    assert motion.joints["belt"].released == pytest.approx(RELEASE)
    assert motion.joints["A"].released is None
    row = motion.joints["belt"].rows_held(motion.time)
    assert motion.time[row - 1] == motion.time[row] == pytest.approx(RELEASE)
    assert motion.joints["A"].rows_held(motion.time) == len(motion.time)
    assert releases(motion) == {"belt": (row, "slips off")}


def test_its_tubes_shrink_to_a_point(motion: Motion) -> None:
    [belt] = belts(motion, {"belt": Held(z=0.01, radius=0.002)})
    poses = Poses(motion)
    for time, is_there in ((0.2, True), (RELEASE, True), (0.51, False), (1.0, False)):
        for path in belt.paths(poses, Moment(time, 0)):
            assert bool(np.ptp(path, axis=0).any()) is is_there
    document = Document()
    animation = Animation(document, motion)
    nodes = add_belt(document, animation, Paints(document), poses, belt)
    scales = {track.node: track.values for track in animation.tracks if track.path == "scale"}
    assert set(scales) == set(nodes)
    for values in scales.values():
        assert values[0].tolist() == [1.0] * 3
        assert values[-1].tolist() == [0.0] * 3
