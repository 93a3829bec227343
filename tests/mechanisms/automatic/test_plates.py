"""Plates round their eyes, rods, and sizes at a scale."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate, harmonic
from mechanisms.stages.automatic.automatic import Automatic, automatic
from mechanisms.stages.automatic.body_shapes import body_shape
from mechanisms.stages.automatic.layout.planar import FLAT, convex_hull, placed
from mechanisms.stages.automatic.layout.sizes import LEAST, RUNNING, STANDARD, fit_at_scale, lengths_of, thin_pins
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.pins.springs import Stretching
from mechanisms.stages.clearance.path import at_scale, what_shrinks
from mechanisms.stages.loading.wishes import scaling
from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from mechanisms.stages.solve.motion_file import to_motion
from shared.shapes.bodies import Bodies
from shared.shapes.facets import volume_of
from shared.shapes.link import Eye
from shared.shapes.standards import Fit
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.scale import Scale, scale_of
from tests.mechanisms.automatic.proofs import meets
from tools.hunt.case import drawn
from tools.hunt_parts import case
from tools.hunt_parts.case import parts_of
from tools.hunt_parts.outcome import BUILT, REFUSED
from tools.models.linkages import four_bar

# Plates round odd sets of eyes, and what hunts for parts found once: each is built, or refused in words.


BIG, SMALL = Eye(13.0, 11.0), Eye(9.0, 4.6)
BOSSED = Eye(12.5, 8.0, above=14.4, boss=9.2)


@pytest.mark.parametrize("length", [111.5, 116.0, 121.57835546275788])
def test_rounded_edges_of_a_bar_with_an_eye_beside_its_end_are_sound(length: float) -> None:
    """The kernel calls a shape valid whose fillets overlap: its mesh was open, or had another volume."""
    end = Eye(12.5, 8.02, boss=9.2)
    shape, holes = body_shape([(length / 5, 0.0, Eye(13.0, 11.02)), (0.0, 0.0, end), (length, 0.0, end)], 7.0)
    solid = only_solid(shape, "beam")
    check_mesh(read_mesh(stl_bytes(solid)), volume_of(solid), holes, "beam")


@pytest.mark.parametrize(
    "eyes",
    [
        [(0.0, 0.0, BIG), (71.0, 0.0, BIG), (60.0, 3.3, Eye(4.0, 0.0)), (71.0, 3.0, Eye(9.0, 0.0))],
        [(0.0, 0.0, BIG), (3.0, 1.0, Eye(9.0, 0.0))],
        [(0.0, 0.0, BIG), (2.0, 0.0, Eye(9.0, 0.0)), (0.0, 2.0, Eye(8.0, 0.0))],
        [(0.0, 0.0, BOSSED), (680.0, 0.0, BIG), (490.0, 72.8, BOSSED)],
    ],
    ids=["an eye within another", "two, one within the other", "all within one", "a thin triangle"],
)
def test_one_sound_piece(eyes: list[tuple[float, float, Eye]]) -> None:
    shape, holes = body_shape(eyes, 7.0)
    (solid,) = shape.solids().vals()
    assert solid.isValid()
    assert holes >= sum(eye.bore > 0 for _, _, eye in eyes)
    box = solid.BoundingBox()
    assert box.xmax >= max(x + eye.radius for x, _, eye in eyes) - 1e-6
    assert box.ymin <= min(y - eye.radius for _, y, eye in eyes) + 1e-6


@given(
    count=st.integers(3, 400), waves=st.integers(1, 12), height=st.floats(0.0, 300.0), length=st.floats(20.0, 5000.0)
)
def test_a_plainer_hull_keeps_all_points(count: int, waves: int, height: float, length: float) -> None:
    """Wavy slots of any length: none is left out by more than FLAT."""
    x = np.linspace(0.0, length, count)
    points = np.stack([x, height * np.sin(waves * x * math.pi / length + 0.3)], axis=1)
    hull = convex_hull(points, 1e-4)
    following = np.roll(hull, -1, axis=0) - hull
    normal = np.stack([following[:, 1], -following[:, 0]], axis=1) / np.hypot(*following.T)[:, None]
    outside = ((points[:, None] - hull[None]) * normal).sum(axis=2).max(axis=1)
    assert outside.max() <= FLAT + 1e-6


@pytest.mark.parametrize(
    ("seed", "family", "state", "words"),
    [
        (7000421, "closed linkage, free", REFUSED, "their bores of"),  # a spring's stud beside a pivot
        (7000721, "Geneva wheel", BUILT, ""),  # a Geneva whose crank never comes near its wheel
        (
            7000805,
            "inverted slider-crank, quick return",
            BUILT,
            "",
        ),  # a rail whose end would be in a bushing of its own body
        (7000891, "linkage, cranks swing", BUILT, ""),  # a spring's post beside a link of the lowest layer
    ],
)
def test_what_hunts_found(seed: int, family: str, state: str, words: str) -> None:
    outcome = case.outcome_of(drawn(seed, family, skipped=2)[1])
    assert outcome.state == state, outcome
    assert words in outcome.detail


# Rods with automatic parts, and linear drivers and ropes between two points.


def four_bar_rods(scale: float = 1.0, turn: float = 0.0, rod: bool = True) -> Mechanism:
    """Its coupler is a rod."""
    m = Mechanism("rodded", gravity=None)
    crank, rocker = m.bar("crank", scale * 0.1), m.bar("rocker", scale * 0.25)
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("D", m.ground.at(0.3 * scale * math.cos(turn), 0.3 * scale * math.sin(turn)), rocker.start)
    if rod:
        m.distance("coupler", crank.end, rocker.end, scale * 0.3)
    else:
        coupler = m.bar("coupler", scale * 0.3)
        m.revolute("B", crank.end, coupler.start)
        m.revolute("C", coupler.end, rocker.end)
    m.drive_angle("motor", crank, constant_rate(6.0))
    near = {"crank": 60.0, "rocker": 100.0} | ({} if rod else {"coupler": 20.0})
    m.start_near(**{body: angle + math.degrees(turn) for body, angle in near.items()})
    return m


@pytest.mark.parametrize(("scale", "turn"), [(1.0, 0.0), (0.1, 1.0), (30.0, -2.0)])
def test_a_rod_lies_where_a_bar_would(scale: float, turn: float) -> None:
    made, barred = (
        Automatic(m, m.sweep()) for m in (four_bar_rods(scale, turn), four_bar_rods(scale, turn, rod=False))
    )
    assert made.levels == barred.levels
    assert made.sizes == barred.sizes
    assert not meets(made)
    pose, there = made.layout.poses["coupler"], barred.layout.poses["coupler"]
    assert pose[:, :2] == pytest.approx(there[:, :2], abs=0.05)
    assert np.cos(pose[:, 2] - there[:, 2]) == pytest.approx(1.0, abs=1e-5)


def test_pins_at_both_ends_are_on_both_bodies() -> None:
    made = Automatic(four_bar_rods(), four_bar_rods().sweep())
    pins = {f.name: f for f in made.layout.select(Pin)}
    assert set(pins) == {"A", "D", "coupler_1", "coupler_2"}
    for pin in (pins["coupler_1"], pins["coupler_2"]):
        seen = [placed(np.array([at]), made.layout.poses[body])[:, 0] for body, at in pin.places.items()]
        assert seen[0] == pytest.approx(seen[1], abs=0.02)
    solids = made.solids(engraved_too=False)
    assert solids.rods == {"coupler": (("crank", 100.0, 0.0), ("rocker", 250.0, 0.0))}
    assert solids["coupler"][0].material == "steel"


def test_a_rod_may_join_a_revolute_joint_and_ground() -> None:
    """A lambda of two rods: one ends on the pin of the crank's other link, one on ground; none touch."""
    m = Mechanism("lambda", gravity=None)
    crank, swing = m.bar("crank", 0.06), m.bar("swing", 0.2)
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("B", crank.end, swing.start)
    m.distance("rod", swing.at(0.14, 0.0), m.ground.at(0.12, -0.12), 0.14)
    m.drive_angle("motor", crank, constant_rate(6.0))
    m.start_near(crank=90, swing=-10)
    outcome = parts_of(m, m.sweep(times=np.linspace(0.0, 2 * math.pi / 6.0, 121)))
    assert outcome.state == "built", outcome


def test_wishes_reach_a_rod() -> None:
    made = Automatic(four_bar_rods(), four_bar_rods().sweep())
    made.material("coupler", "brass")
    made.layer("coupler", 0)
    assert made.levels["coupler"] == 0
    assert made.solids(engraved_too=False)["coupler"][0].material == "brass"
    made = Automatic(four_bar_rods(), four_bar_rods().sweep())
    made.leave_out("coupler")
    solids = made.solids(engraved_too=False)
    assert "coupler" not in solids
    assert not solids.left_out
    assert [solid.through_holes for solid in (solids["crank"][0], solids["rocker"][0])] == [2, 2]


def test_a_joint_that_is_called_like_a_body_has_a_rod_of_another_name() -> None:
    m = four_bar_rods()
    m.joints["crank"] = m.joints.pop("coupler")
    assert set(Automatic(m, m.sweep()).levels) == {"crank", "rocker", "rod_crank"}


def stretched(made: Automatic) -> dict[str, Stretching]:
    return {feature.force: feature for feature in made.layout.select(Stretching)}


def test_a_linear_driver_is_a_cylinder_between_studs() -> None:
    m = Mechanism("lift", gravity=None)
    arm = m.bar("arm", 0.3)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_distance("ram", m.ground.at(0.2, -0.1), arm.at(0.2, 0), harmonic(0.22, 0.05, 1.0))
    m.start_near(arm=60)
    made = Automatic(m, m.sweep(6.0))
    ram = stretched(made)["ram"]
    assert ram.outer == pytest.approx(0.6 * ram.radius)
    held = [
        hold.force for solids in made.solids(engraved_too=False).values() for solid in solids for hold in solid.holds
    ]
    assert held == ["ram", "ram"]


@pytest.mark.parametrize("gravity", [(0.0, -9.81), None])
def test_a_rope_has_studs_and_room_to_hang(gravity: tuple[float, float] | None) -> None:
    """Its parabola lies in the triangle that is kept free, whenever it is slack."""
    from render.film.tubes.stretched import sagging

    m = Mechanism("roped", gravity=gravity)
    arm = m.bar("arm", 0.3, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.rope("rope", m.ground.at(0.3, 0.3), arm.at(0.2, 0), 0.35)
    m.start_near(arm=60)
    m.start_moving(arm=(0.0, 0.0, -3.0))
    solution = m.simulate(0.5, 60, event_rows=True)
    made = Automatic(m, solution)
    feature = stretched(made)["rope"]
    assert feature.sags is not None
    slack = np.linalg.norm(feature.path[:, 1] - feature.path[:, 0], axis=1) < made.sizes.of_metres(0.3499)
    assert slack.any()
    assert feature.sags.any() == (gravity is not None)
    down = np.array([0.0, -1.0 if gravity else 0.0, 0.0])
    for (a, b), sag in zip(feature.path[::50], feature.sags[::50], strict=True):
        rope = sagging(np.array([*a, 0.0]), np.array([*b, 0.0]), made.sizes.of_metres(0.35), down)[:, :2]
        lowest = (rope - (a + np.linspace(0, 1, len(rope))[:, None] * (b - a)))[:, 1].min()
        assert 2 * lowest >= sag[1] - 1e-6
    held = [
        hold.force for solids in made.solids(engraved_too=False).values() for solid in solids for hold in solid.holds
    ]
    assert held == ["rope", "rope"]


# Automatic parts of models at a scale: places go with the machine, pins and clearances with the printer.


AT = Scale(1, 4)
PIN = 6.0
"""Diameter of the pins of :func:`large` at that scale (mm)."""


def large() -> Mechanism:
    """Half a metre."""
    return four_bar(0.36, 0.12, 0.36, 0.27)


def test_pins_that_two_near_joints_make_thin_are_reported_with_their_names() -> None:
    """2 mm between two crank pins gave an engine of 0.22 g, without a word."""
    m = large()
    solution = m.sweep(steps=90)
    assert not thin_pins(lengths_of(m, solution), automatic(m, solution=solution).sizes.pin)
    spare = m.body("spare")
    m.revolute("spare_pin", m.bodies["crank"].at(0.118, 0.0), spare.origin)
    m.drive_relative_angle("hold", m.bodies["crank"], spare, constant_rate(0.0))
    m.start_near(spare=0)
    solution = m.sweep(steps=90)
    said = thin_pins(lengths_of(m, solution), automatic(m, solution=solution).sizes.pin)
    assert said.startswith(
        "pins of 0.6 mm, because the distance of 'B' and 'spare_pin' on 'crank' is 2 mm; a machine of"
    )
    assert "would have pins of 25 mm" in said


def scaled_parts(scale: Scale | None, m: Mechanism | None = None, **words: object) -> Automatic:
    m = m or large()
    with scaling(scale):
        made = automatic(m, solution=m.sweep(1.0, 120), **words)
        made.levels  # noqa: B018
    return made


@pytest.mark.parametrize("text", ["1:4", "1:8", "1:12", "2:1"])
def test_pins_are_standard_and_can_be_printed(text: str) -> None:
    scale = scale_of(text)
    made = scaled_parts(scale)
    assert scale is not None
    assert made.sizes.finished_pin in STANDARD
    assert made.sizes.finished_pin >= LEAST
    assert made.sizes.pin == pytest.approx(made.sizes.finished_pin / scale.ratio)
    assert meets(made) == []
    fit, size = made.sizes.pivot.fit, made.sizes.finished
    assert fit.running * size >= 0.3 - 1e-9
    assert fit.press * size >= 0.1 - 1e-9
    assert fit.axial * size >= 0.3 - 1e-9


def test_of_smaller_models_pins_are_thicker_in_proportion() -> None:
    """1:14 of 120 mm is 8.57 mm, of which 8.25 mm are needed."""
    assert scaled_parts(Scale(1, 14)).sizes.finished_pin == LEAST
    assert scaled_parts(Scale(1, 14)).sizes.pin > 1.2 * scaled_parts(Scale(1, 4)).sizes.pin


def test_links_that_are_too_short_are_named_with_the_scale_that_would_do() -> None:
    with pytest.raises(UserError, match=r"'A' and 'B' on 'crank' becomes 6 mm, .* need 8\.25 mm; SCALE=1:14 is"):
        scaled_parts(Scale(1, 20))
    assert scaled_parts(Scale(1, 14)).levels
    with pytest.raises(UserError, match=r"SCALE=3:1 is the smallest"):
        scaled_parts(Scale(1, 1), four_bar(0.009, 0.003, 0.009, 0.007))


def test_without_a_scale_sizes_are_those_of_the_machine() -> None:
    sizes = scaled_parts(None).sizes
    assert (sizes.ratio, sizes.finished, sizes.finished_pin) == (1.0, sizes.scale, sizes.pin)


def test_a_printers_own_fit_counts_and_a_pin_goes_with_the_machine() -> None:
    made = scaled_parts(AT, fit=Fit(running=0.5, press=0.2), pin=20.0)
    assert made.sizes.finished_pin == 5.0
    assert made.sizes.pivot.fit.running * made.sizes.finished == pytest.approx(0.5)


@pytest.fixture(scope="module")
def model() -> Bodies:
    m = large()
    with scaling(AT):
        return automatic(m, solution=m.sweep(1.0, 120)).solids(engraved_too=False).on_stand().at_scale(AT.ratio)


def test_solids_are_those_of_the_model(model: Bodies) -> None:
    """Pins are as far apart as the model's, screws and washers those of the finished piece."""
    box = model["coupler"][0].shape.val().BoundingBox()
    eye = 13.0 / 8.0 * PIN
    assert box.xmax - box.xmin == pytest.approx(mm(0.36) / 4 + 2 * eye, abs=1e-3)
    pins = [solid for solid in model["ground"] if solid.name == "pin_A"]
    widths = pins[0].shape.val().BoundingBox()
    assert widths.xmax - widths.xmin == pytest.approx(PIN, abs=0.1)
    names = {solid.buy for solids in model.values() for solid in solids if solid.buy}
    assert any("ring 6x12" in name for name in names)
    assert all(solid.fitted for solids in model.values() for solid in solids)


def test_solids_of_an_author_become_smaller_as_they_are(model: Bodies) -> None:
    """And nothing of them is bought; those that fit keep what they are called in a shop."""
    from dataclasses import replace

    washer = next(solid for solids in model.values() for solid in solids if solid.buy)
    own = replace(washer, fitted=False)
    assert Bodies(ground=[own]).at_scale(0.5)["ground"][0].buy == ""
    assert Bodies(ground=[washer]).at_scale(0.5)["ground"][0].buy == washer.buy
    half = Bodies(ground=[own]).at_scale(0.5)["ground"][0]
    assert half.shape.val().Volume() == pytest.approx(own.shape.val().Volume() / 8, rel=1e-6)


def test_rods_end_where_those_of_the_model_do() -> None:
    made = Bodies(ground=[], arm=[])
    made.join_places("rod", ("arm", 80.0, 0.0), ("ground", 120.0, 10.0))
    assert made.at_scale(0.1).rods["rod"] == (("arm", 8.0, 0.0), ("ground", 12.0, 1.0))


def test_a_model_moves_as_its_machine() -> None:
    m = large()
    motion = to_motion(m.sweep(1.0, 40), None, "0" * 64, {})
    small = at_scale(motion, 0.25)
    for name, body in motion.bodies.items():
        assert np.allclose(small.bodies[name].vx, np.array(body.vx) / 4, rtol=1e-15)
        assert small.bodies[name].theta == body.theta
    assert np.allclose(small.joints["C"].x, np.array(motion.joints["C"].x) / 4, rtol=1e-15)


def test_a_refusal_of_a_model_says_which_fit_would_do() -> None:
    """The fit that it names leaves at the scale what the default leaves in the machine."""
    half = scale_of("1:2")
    assert half is not None
    named = float(re.search(r"Fit\(running=([0-9.]+)\)", what_shrinks(half))[1])  # type: ignore[index]
    assert named * half.ratio == pytest.approx(Fit().running)


def test_a_parts_file_gets_clearances_for_the_scale() -> None:
    assert fit_at_scale(PIN) == Fit()
    for scale in (Scale(1, 2), Scale(1, 20)):
        with scaling(scale):
            fit = fit_at_scale(PIN)
        assert fit.running * scale.ratio == pytest.approx(RUNNING)
        assert min(fit.press, fit.axial) * scale.ratio >= 0.1 - 1e-12
