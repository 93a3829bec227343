"""Arrows and arcs of the film: their loads, lengths and legend; no Blender but for one picture."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any, get_args

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from render.blender.scene.arrows import ARC_SIDES as SIDES
from render.blender.scene.arrows import FRONT, RINGS, sizes
from render.blender.scene.arrows import arc_faces as faces
from render.blender.scene.arrows import arc_vertices as vertices
from render.blender.worker import words
from render.film import arrows, composing
from render.film.arrows import APART, FULL, FULL_TURN, RADIUS, Arcs, Arrows
from render.film.framing import project
from render.film.inputs import named, read_film
from render.film.scene import ArcSpec, ArrowSpec, LegendRow, Writing
from render.film.vectors import (
    LONGEST,
    TINY,
    Torque,
    Vector,
    at_time,
    round_below,
    rounding,
    scales_of,
    torques,
    vectors,
)
from render.frames import still
from render.presets import ASPECT, WORDS, Preset, show_words
from shared.contract import Action, Acts, DriverMotion, ForceMotion, Motion
from shared.contract.shot import Quantity, Shot, Title, shown
from shared.contract.signals import SIGNALS, rgb
from shared.stage.errors import UserError
from tools.fixtures import film_fixture
from tools.models.motions import GRAVITY, MASSES, bouncing_ball, four_bar_motion

FORCE, WEIGHT = (rgb(SIGNALS[name].dark) for name in ("forces", "weights"))

TIME = np.linspace(0.0, 1.0, 101)


def steady(size: np.ndarray | float, quantity: str = "forces") -> Vector:
    """A vector along x of that size over TIME."""
    value = np.column_stack([np.broadcast_to(size, TIME.shape), np.zeros_like(TIME)])
    return Vector(quantity, "load", ("bar",), np.zeros_like(value), value)  # pyright: ignore[reportArgumentType]


def test_the_reactions_of_each_body_and_its_weight_are_its_mass_times_its_acceleration():
    motion = four_bar_motion()
    made = {vector.name: vector for vector in vectors(motion, ("reactions", "forces", "accelerations"))}
    # B acts on the coupler, C on the rocker, so on the coupler the reverse.
    force = made["B"].value - made["C"].value + made["weight of coupler"].value
    assert made["weight of coupler"].value == pytest.approx(np.tile(MASSES["coupler"] * GRAVITY, (361, 1)))
    body = motion.bodies["coupler"]
    theta, omega, alpha = np.array(body.theta), np.array(body.omega), np.array(body.alpha)
    arm = body.com[0] * np.stack([np.cos(theta), np.sin(theta)], axis=1)
    centre = np.stack([body.ax, body.ay], axis=1) - omega[:, None] ** 2 * arm
    centre += alpha[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    assert force == pytest.approx(MASSES["coupler"] * centre, abs=1e-9)
    assert "accelerations of P" in made
    rocker = 0.5 * made["accelerations of C"].value  # a bar that turns about D: its middle has half
    assert made["C"].value + made["D"].value + made["weight of rocker"].value == pytest.approx(
        MASSES["rocker"] * rocker, abs=1e-9
    )


def test_pins_that_move_have_velocities_once_each_and_centres_of_mass_none_beside_them():
    names = [vector.name for vector in vectors(four_bar_motion(), ("velocities",))]
    assert names == ["velocities of P", "velocities of B", "velocities of C"]
    ball = msgspec.structs.replace(bouncing_ball(), points={})
    assert [vector.name for vector in vectors(ball, ("velocities",))] == ["velocities of ball"]


def test_velocities_are_those_of_the_places_they_begin_at():
    for vector in vectors(four_bar_motion(), ("velocities",)):
        slope = np.gradient(vector.place, 1 / 360, axis=0)[1:-1]
        assert vector.value[1:-1] == pytest.approx(slope, abs=2e-4), vector.name


def test_at_an_impact_the_later_row_counts_and_nothing_is_blended_across_it():
    motion = bouncing_ball()
    time, strike = np.array(motion.time), motion.events[0].time
    speed = np.array(motion.bodies["ball"].vy)[:, None]
    before, at, after = (float(at_time(time, speed, t)[0]) for t in (strike - 1e-9, strike, strike + 1e-9))
    assert before == pytest.approx(-2 * at, rel=1e-6)
    assert at == pytest.approx(after, rel=1e-6)
    assert float(at_time(time, speed, 99.0)[0]) == pytest.approx(speed[-1, 0])


def test_the_largest_has_the_full_length_and_tiny_ones_are_left_out():
    made = Arrows(TIME, [steady(50.0), steady(5.0), steady(0.5 * TINY * 50.0)], size=0.4)
    assert [vector.size[0] for vector in made.vectors] == [50.0, 5.0]
    (tail, tip), (_, second) = made.ends_at(0.5, [0.01, 0.02])
    assert tail == (0.0, 0.0, 0.01)
    assert tip == pytest.approx((FULL * 0.4, 0.0, 0.01))
    assert second == pytest.approx((FULL * 0.04, 0.0, 0.02))
    fading = Arrows(TIME, [steady(100.0 * (1 - TIME))], size=1.0)
    (tail, tip) = fading.ends_at(0.999, [0.0])[0]
    assert tail == tip
    assert fading.tips([0.0])[0][0] == pytest.approx([FULL, 0.0, 0.0])


def test_a_short_peak_is_cut_and_the_legend_says_so():
    pulse = np.where(np.abs(TIME - 0.5) < 0.006, 300.0, 10.0)
    made = Arrows(TIME, [steady(pulse)], size=1.0)
    assert made.ends_at(0.5, [0.0])[0][1][0] == pytest.approx(FULL * LONGEST)
    assert made.ends_at(0.2, [0.0])[0][1][0] == pytest.approx(FULL * 10.0 / made.scales["N"].largest)
    row = made.legend(2.0)[0]
    assert row.words == "forces, peaks cut"
    assert row.length == pytest.approx(FULL * made.scales["N"].reference / made.scales["N"].largest / 2.0)


def test_blows_that_return_leave_the_rest_to_be_seen():
    """A hammer strikes in 6 % of the time with ten times the force of its spring."""
    blows = np.where(TIME * 100 % 17 < 1, 100.0, 10.0)
    assert Arrows(TIME, [steady(blows)], size=1.0).scales["N"].largest == pytest.approx(10.0)
    assert Arrows(TIME, [steady(blows)], size=1.0).legend(1.0)[0].words == "forces, peaks cut"
    gentle = np.where(blows > 50.0, 30.0, 10.0)
    assert Arrows(TIME, [steady(gentle)], size=1.0).scales["N"].largest == pytest.approx(30.0)


def test_forces_and_reactions_share_one_scale_and_nothing_has_none():
    made = Arrows(TIME, [steady(3.0), steady(7.0, "reactions"), steady(2.0, "velocities")], size=1.0)
    assert set(made.scales) == {"N", "m/s"}
    assert [(row.number, row.words) for row in made.legend(1.0)] == [
        ("5 N", "forces"),
        ("5 N", "reactions"),
        ("1 m/s", "velocities"),
    ]
    assert scales_of([steady(0.0)]) == {}
    assert Arrows(TIME, [steady(0.0)], size=1.0).specs() == []


@pytest.mark.parametrize(
    ("value", "below"), [(1.0, 1.0), (0.99, 0.5), (4.999, 2.0), (5.0, 5.0), (0.0031, 0.002), (7.2e5, 5e5)]
)
def test_round_numbers(value: float, below: float):
    assert round_below(value) == pytest.approx(below)


def test_short_arrows_shrink_as_a_whole_and_no_shaft_is_longer_than_its_arrow():
    spec = ArrowSpec(name="a", colour=(1, 1, 1), shaft=0.001, head=0.003, point=0.01)
    length = np.array([1e-7, 0.005, 0.02, 0.1])
    factor, shaft = sizes(spec, length)
    assert (shaft > 0).all()
    assert shaft + factor * spec.point == pytest.approx(length)
    assert factor[-1] == 1.0
    assert factor[1] < 0.5


def test_words_of_show_are_checked_ordered_and_replace_what_the_shot_says():
    assert (*get_args(Quantity), "title") == WORDS
    assert show_words(" title,reactions , velocities") == "velocities,reactions,title"
    with pytest.raises(UserError, match="did you mean 'reactions'"):
        show_words("reaction")
    with pytest.raises(UserError, match="these are among forces and reactions"):
        show_words("contact")
    shot = Shot(show=("forces",), title=Title(text="Crank"))
    assert shown(shot, "") is shot
    assert shown(shot, "velocities") == msgspec.structs.replace(shot, show=("velocities",), title=None)
    assert shown(shot, "reactions,title").title == Title(text="Crank")
    assert named(Path("a/poster.png"), "forces,title") == Path("a/poster-forces-title.png")


def test_frames_with_arrows_have_keys_of_their_own(out_root: Path):
    from render.frames.frames import Pictures
    from render.presets import PRESETS

    out = film_fixture.write(Shot(seconds_per_turn=0.2))
    key_sets = [
        {made.key(frame) for frame in range(made.film.clock.frames)}
        for made in (
            Pictures(read_film(out, show), PRESETS["draft"])
            for show in ("", "reactions", "velocities", "reactions,title", "title")
        )
    ]
    assert all(len(keys) == 6 for keys in key_sets)
    assert len(set().union(*key_sets)) == 30


def test_tips_of_arrows_stay_in_the_picture(out_root: Path):
    film = read_film(film_fixture.write(Shot(seconds_per_turn=0.4)), "reactions,accelerations")
    for frame in range(film.clock.frames):
        state = film.state(frame)
        pixels = project(state.camera, np.array([tip for _, tip in state.arrows]), 1280, 720)
        assert (pixels > 0).all()
        assert (pixels < (1280, 720)).all()


def test_an_arrow_is_drawn_where_its_tip_is_and_over_what_is_in_front(out_root: Path):
    preset = Preset("stamp", 240, 135, 2)
    out = film_fixture.write(Shot(seconds_per_turn=0.4, trails=()))
    film = read_film(out, "reactions")
    still.still("four_bar", preset, 5, "reactions")
    still.still("four_bar", preset, 5)
    with_arrows, plain = (
        np.asarray(Image.open(out.stills / f"stamp-0005{end}.png").convert("RGB")).astype(int)
        for end in ("-reactions", "")
    )
    assert plain.shape == with_arrows.shape
    state = film.state(5)
    for tail, tip in state.arrows:
        if np.hypot(tip[0] - tail[0], tip[1] - tail[1]) < 0.02:
            continue
        inside = np.array(tail) + 0.8 * (np.array(tip) - tail)
        x, y = project(state.camera, inside[None], 240, 135)[0].astype(int)
        patch = with_arrows[y - 1 : y + 2, x - 1 : x + 2].reshape(-1, 3)
        assert (patch[:, 2] - patch[:, 0]).max() > 90  # blue


def test_weights_have_a_row_and_a_colour_of_their_own_and_the_scale_of_the_forces():
    made = Arrows(TIME, [steady(10.0), dataclasses.replace(steady(5.0), weight=True)], size=1.0)
    assert [spec.colour for spec in made.specs()] == [FORCE, WEIGHT]
    forces, weights = made.legend(2.0)
    assert (forces.words, weights.words) == ("forces", "weights")
    assert (forces.number, forces.length) == (weights.number, weights.length)
    assert {v.name for v in vectors(four_bar_motion(), ("forces",)) if v.weight} >= {"weight of coupler"}


TORQUE = rgb(SIGNALS["torques"].dark)

SPEC = ArcSpec(name="a", colour=(1, 1, 1), radius=0.02, shaft=0.0012, head=0.0036, point=0.01)


def steady_torque(value: np.ndarray | float, quantity: str = "forces", at: tuple[float, float] = (0.0, 0.0)) -> Torque:
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
    made = Arcs(TIME, [steady_torque(-50.0), steady_torque(5.0, at=(1, 0)), steady_torque(0.4 * TINY * 50.0)], size=0.4)
    assert [torque.value[0] for torque in made.torques] == [-50.0, 5.0]
    assert [sweep for _, sweep, _ in made.sweeps_at(0.5, [0.01, 0.02])] == pytest.approx([-FULL_TURN, FULL_TURN / 10])
    assert [row.number for row in made.legend()] == ["20 N·m"]
    assert made.legend()[0].sweep == pytest.approx(FULL_TURN * 20 / 50)
    forces = vectors(four_bar_motion(), ("forces", "reactions"))
    least = rounding(forces, 0.3)
    assert 0 < least < 1e-8
    assert Arcs(TIME, [steady_torque(0.5 * least)], 0.3, least).specs() == []
    fading = Arcs(TIME, [steady_torque(100.0 * (1 - TIME))], size=1.0)
    assert fading.sweeps_at(0.999, [0.0])[0][1] == 0.0


def test_a_short_peak_is_cut_and_no_arc_meets_its_own_tail():
    pulse = np.where(np.abs(TIME - 0.5) < 0.006, 300.0, 10.0)
    made = Arcs(TIME, [steady_torque(pulse, "reactions")], size=1.0)
    assert made.sweeps_at(0.5, [0.0])[0][1] == pytest.approx(FULL_TURN * LONGEST)
    assert 1.8 * np.pi > FULL_TURN * LONGEST
    assert made.legend()[0].words == "torques of joints, peaks cut"


def test_arcs_about_one_point_lie_around_each_other_and_the_camera_holds_them():
    made = Arcs(TIME, [steady_torque(1.0), steady_torque(-2.0, "reactions"), steady_torque(1.0, at=(1, 0))], size=2.0)
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
        row = LegendRow(number="5 N·m", words="torques", colour=TORQUE, sweep=sweep)
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
    assert arrows.number(acting, shot)(0.0) == "spring  300 mN·m"
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
    [(centre, sweep, axis)] = state.arcs
    assert axis == (0.0, 0.0, 1.0)
    assert abs(sweep) > 0.5
    pixels = project(state.camera, vertices(spec, centre, sweep).reshape(RINGS + 2, SIDES, 3).mean(axis=1), 240, 135)
    assert ((pixels > 0) & (pixels < (240, 135))).all()
    x, y = pixels[RINGS // 2].astype(int)
    patch = picture[y - 1 : y + 2, x - 1 : x + 2].reshape(-1, 3)
    assert (patch[:, 0] - patch[:, 2]).max() > 90  # orange
