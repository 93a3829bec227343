"""Curved arrows of the film: which torques they stand for, how far they reach, and forces of drivers of a length."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from render.blender.scene.arrows import ARC_SIDES as SIDES
from render.blender.scene.arrows import FRONT, RINGS
from render.blender.scene.arrows import arc_faces as faces
from render.blender.scene.arrows import arc_vertices as vertices
from render.blender.worker import words
from render.film import arrows, composing
from render.film.arrows import APART, FULL_TURN, RADIUS, Arcs
from render.film.framing import project
from render.film.inputs import read_film
from render.film.scene import ArcSpec, LegendRow, Writing
from render.film.vectors import LONGEST, TINY, Torque, rounding, torques, vectors
from render.frames import still
from render.presets import ASPECT, Preset
from shared.contract import Action, Acts, DriverMotion, ForceMotion, Motion
from shared.contract.shot import Shot, Title
from shared.contract.signals import SIGNALS, rgb
from tools.fixtures import film_fixture
from tools.models.motions import four_bar_motion

TORQUE = rgb(SIGNALS["torques"].dark)

TIME = np.linspace(0.0, 1.0, 101)
SPEC = ArcSpec(name="a", colour=(1, 1, 1), radius=0.02, shaft=0.0012, head=0.0036, point=0.01)


def steady(value: np.ndarray | float, quantity: str = "forces", at: tuple[float, float] = (0.0, 0.0)) -> Torque:
    """A torque about a point, over TIME."""
    values = np.broadcast_to(value, TIME.shape)
    return Torque(quantity, "motor", ("ground", "bar"), np.tile(at, (len(TIME), 1)), values)  # pyright: ignore[reportArgumentType]


def with_driver(motion: Motion, **fields: Any) -> Motion:
    """The four-bar with another driver."""
    count = len(motion.time)
    blank = {"value": [0.0] * count, "effort": [2.0] * count, "power": [0.0] * count}
    return msgspec.structs.replace(motion, drivers={"lift": DriverMotion(**blank | fields)})


def with_force(motion: Motion, torque: float, bodies: tuple[str, ...], drives: bool = False) -> Motion:
    """The four-bar with a torque on these bodies at D, the opposite on the first of two."""
    d, count = motion.joints["D"], len(motion.time)
    zero = [0.0] * count
    actions = [
        Action(body=body, x=d.x, y=d.y, fx=zero, fy=zero, torque=[sign * torque] * count)
        for body, sign in zip(bodies, (-1.0, 1.0)[-len(bodies) :], strict=True)
    ]
    force = ForceMotion(
        kind="any", actions=actions, several=False, measures="angle", value=zero, rate=zero, effort=[torque] * count,
        normal=None, power=zero, potential=zero, shape=None, effort_unit="N m", drives=drives,
    )  # fmt: skip
    return msgspec.structs.replace(motion, forces={"spring": force})


def test_the_motors_torque_is_drawn_about_the_pin_it_turns():
    motion = four_bar_motion()
    [motor] = torques(motion, ("forces",))
    assert motor.name == "motor on crank"
    assert motor.value == pytest.approx(motion.drivers["motor"].effort)
    assert motor.place == pytest.approx(np.zeros((361, 2)))
    motion.drivers["motor"].actions.reverse()  # of a driver from the crank to ground
    assert torques(motion, ("forces",))[0].name == "motor on crank"
    assert torques(motion, ("velocities", "accelerations")) == []


def test_a_torque_between_two_bodies_is_drawn_once_and_as_the_moving_one_feels_it():
    motion = with_force(four_bar_motion(), 0.3, ("ground", "rocker"))
    [spring, *_] = torques(motion, ("forces",))
    assert (spring.name, spring.bodies) == ("spring on rocker", ("ground", "rocker"))
    assert spring.value == pytest.approx(0.3)
    assert spring.place[0] == pytest.approx([0.12, 0.0])
    [other, *_] = torques(with_force(four_bar_motion(), 0.3, ("rocker", "ground")), ("forces",))
    assert (other.name, other.value[0]) == ("spring on rocker", -0.3)


def test_a_guide_has_a_torque_and_what_acts_beside_its_marker_the_torque_there():
    motion = four_bar_motion()
    count = len(motion.time)
    beside = Acts(x=[0.3] * count, y=[0.1] * count, torque=[0.0] * count)
    for acts, value, place in ((None, 0.2, (0.12, 0.0)), (beside, 0.0, (0.3, 0.1))):
        joint = msgspec.structs.replace(motion.joints["D"], kind="any", pair=None, torque=[0.2] * count, acts=acts)
        changed = msgspec.structs.replace(motion, joints=motion.joints | {"D": joint})
        [at_d] = [torque for torque in torques(changed, ("reactions",)) if torque.name == "D"]
        [push] = [vector for vector in vectors(changed, ("reactions",)) if vector.name == "D"]
        assert at_d.value == pytest.approx(np.full(count, value))
        assert at_d.place[0] == pytest.approx(place)
        assert push.place[0] == pytest.approx(place)


def test_the_largest_has_the_full_sweep_tiny_ones_and_rounding_are_left_out():
    made = Arcs(TIME, [steady(-50.0), steady(5.0, at=(1, 0)), steady(0.4 * TINY * 50.0)], size=0.4)
    assert [torque.value[0] for torque in made.torques] == [-50.0, 5.0]
    assert [sweep for _, sweep in made.sweeps_at(0.5, [0.01, 0.02])] == pytest.approx([-FULL_TURN, FULL_TURN / 10])
    assert [row.number for row in made.legend()] == ["20 N m"]
    assert made.legend()[0].sweep == pytest.approx(FULL_TURN * 20 / 50)
    forces = vectors(four_bar_motion(), ("forces", "reactions"))
    least = rounding(forces, 0.3)
    assert 0 < least < 1e-8
    assert Arcs(TIME, [steady(0.5 * least)], 0.3, least).specs() == []
    fading = Arcs(TIME, [steady(100.0 * (1 - TIME))], size=1.0)
    assert fading.sweeps_at(0.999, [0.0])[0][1] == 0.0


def test_a_short_peak_is_cut_and_no_arc_meets_its_own_tail():
    pulse = np.where(np.abs(TIME - 0.5) < 0.006, 300.0, 10.0)
    made = Arcs(TIME, [steady(pulse, "reactions")], size=1.0)
    assert made.sweeps_at(0.5, [0.0])[0][1] == pytest.approx(FULL_TURN * LONGEST)
    assert 1.8 * np.pi > FULL_TURN * LONGEST
    assert made.legend()[0].words == "torques of joints, peaks cut"


def test_arcs_about_one_point_lie_around_each_other_and_the_camera_holds_them():
    made = Arcs(TIME, [steady(1.0), steady(-2.0, "reactions"), steady(1.0, at=(1, 0))], size=2.0)
    assert msgspec.json.encode(made.specs())  # plain numbers, which Blender's process is sent
    assert [spec.radius for spec in made.specs()] == pytest.approx([2 * RADIUS, 2 * (RADIUS + APART), 2 * RADIUS])
    for spec, rim in zip(made.specs(), made.rims([0.1] * 3), strict=True):
        assert np.ptp(rim, axis=0)[:2] == pytest.approx(2 * (spec.radius + spec.head))
        assert (rim[:, 2] == 0.1).all()


@given(st.floats(-1.8 * np.pi, 1.8 * np.pi).filter(lambda sweep: abs(sweep) > 0.05))
def test_the_mesh_of_an_arc_is_closed_begins_and_ends_where_it_should_and_faces_outwards(sweep: float):
    import trimesh

    centre = (0.1, -0.2, 0.03)
    points = vertices(SPEC, centre, sweep).astype(float)
    rings = points.reshape(RINGS + 2, SIDES, 3).mean(axis=1) - centre
    for ring, angle in ((0, FRONT - sweep / 2), (RINGS + 1, FRONT + sweep / 2)):
        assert rings[ring] == pytest.approx([SPEC.radius * np.cos(angle), SPEC.radius * np.sin(angle), 0], abs=2e-6)
    around, ends = faces()
    triangles = [(face[0], face[k], face[k + 1]) for face in around + ends for k in range(1, len(face) - 1)]
    mesh = trimesh.Trimesh(points, triangles, process=False)
    assert mesh.is_watertight
    assert mesh.volume > 0


def test_an_arc_that_is_not_there_has_no_size():
    points = vertices(SPEC, (0.0, 0.0, 0.0), 0.0)
    assert np.isfinite(points).all()
    assert np.ptp(points, axis=0).max() < 1e-6


def test_the_legend_shows_how_far_an_arc_reaches(tmp_path: Path):
    path = tmp_path / "p.png"
    seen = []
    for sweep in (0.5 * np.pi, np.pi):
        Image.new("RGB", (640, 360), (40, 40, 40)).save(path)
        row = LegendRow(number="5 N m", words="torques", colour=TORQUE, sweep=sweep)
        card = composing.cards([row], composing.box_of([]), ASPECT)["lower right"]
        words.lay(path, None, Writing(legend=[row], card=card), "")
        orange = np.abs(np.asarray(Image.open(path)) - 255 * np.array(TORQUE)).sum(axis=2) < 40
        seen.append(int(orange.sum()))
    assert 12 < seen[0] < 0.75 * seen[1]


def test_the_number_beside_the_title_is_of_what_acts_where_the_drivers_give_nothing():
    shot = Shot(title=Title())
    idle = with_driver(four_bar_motion(), kind="any", effort=[0.0] * 361)
    assert arrows.number(idle, shot)(0.0).startswith("lift")
    acting = with_force(idle, 0.3, ("rocker",), True)
    assert arrows.number(acting, shot)(0.0) == "spring  300 mN m"
    assert arrows.number(with_force(four_bar_motion(), 0.3, ("rocker",), True), shot)(0.0).startswith("motor")


def test_an_arc_is_drawn_where_it_is(out_root: Path):
    preset = Preset("stamp", 240, 135, 2)
    out = film_fixture.write(Shot(seconds_per_turn=0.4, trails=()))
    motion = four_bar_motion()
    from shared.contract import write_motion

    write_motion(out.motion, motion)
    film = read_film(out, "forces")
    still.still("four_bar", preset, 5, "forces")
    picture = np.asarray(Image.open(out.stills / "stamp-0005-forces.png").convert("RGB")).astype(int)
    state, [spec] = film.state(5), film.scene.arcs
    [(centre, sweep)] = state.arcs
    assert abs(sweep) > 0.5
    pixels = project(state.camera, vertices(spec, centre, sweep).reshape(RINGS + 2, SIDES, 3).mean(axis=1), 240, 135)
    assert ((pixels > 0) & (pixels < (240, 135))).all()
    x, y = pixels[RINGS // 2].astype(int)
    patch = picture[y - 1 : y + 2, x - 1 : x + 2].reshape(-1, 3)
    assert (patch[:, 0] - patch[:, 2]).max() > 90  # orange
