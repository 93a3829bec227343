"""Arrows of the film: what they stand for, how long they are, what the legend says; no Blender but for one picture."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import get_args

import msgspec
import numpy as np
import pytest
from PIL import Image

from render.blender.scene.arrows import sizes
from render.film.arrows import FULL, Arrows
from render.film.framing import project
from render.film.inputs import named, read_film
from render.film.scene import ArrowSpec
from render.film.vectors import LONGEST, TINY, Vector, at_time, round_below, scales_of, vectors
from render.frames import still
from render.presets import WORDS, Preset, show_words
from shared.contract.quantity import written
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
    """Of a hammer that strikes in 6 % of the time with ten times the force of its spring."""
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


@pytest.mark.parametrize(
    ("value", "unit", "said"),
    [
        (0.5, "N", "500 mN"), (20.0, "N", "20 N"), (5e3, "N", "5 kN"), (0.02, "N", "20 mN"), (2e-6, "N", "2 µN"),
        (0.2, "m/s", "200 mm/s"), (0.05, "m/s", "50 mm/s"), (2000.0, "m/s²", "2000 m/s²"),
    ],
)  # fmt: skip
def test_numbers_of_the_legend(value: float, unit: str, said: str):
    assert written(value, unit) == said


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
