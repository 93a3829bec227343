"""Addresses of PMKS+: sliders of both ages, drives at floating pins and along slots, units, directions, checks."""

from __future__ import annotations

import math

import numpy as np
import pytest

from shared.stage.errors import UserError
from studio.imports.pmks_records import stamped
from studio.imports.reading import read
from tests.studio.imports.imported import SAMPLES, built

ADDRESSES = dict(line.split("\t") for line in (SAMPLES / "pmks_plus.tsv").read_text().splitlines())
FREEDOM = {"three_machines": 3, "pumping_field": 3, "four_bar_inversions": 4, "slider_crank_inversions": 4}
"""Degrees of freedom of those that have more than one."""
PUSHED = {
    "cylinder_boom": "P",
    "parallel_gripper": "A",
    "backhoe_bucket": "C",
    "scissor_lift": "C",
    "screw_jack": "A",
    "elliptical_trammel": "A",
    "press_crosshead_2026": "S",
}
"""Addresses with a drive along a slider."""
LOADED = {"punch_press": 1, "punch_press_2026": 1, "crane_two_loads": 2}
"""Addresses with forces."""


@pytest.mark.parametrize("name", ADDRESSES)
def test_a_published_address_is_read_completely(name: str) -> None:
    sketch, m, _ = built(ADDRESSES[name])
    freedom = FREEDOM.get(name, 1)
    assert sketch.freedom == sketch.counted_freedom() == m.mobility().dof == freedom
    assert len(m.drivers) == freedom
    assert [finding for finding in m.check() if not finding.is_note] == []
    expected = []
    if name in PUSHED:
        expected.append(f"input {PUSHED[name]}: PMKS+ turns it round at the ends of its travel, here it goes on")
    assert sketch.left_out == expected
    assert len(m.forces) == LOADED.get(name, 0)


def test_a_slider_crank_moves_as_its_closed_form() -> None:
    """Three records make the slider: its slot, its pin and the block of both."""
    sketch, m, names = built(ADDRESSES["slider_crank"])
    p, points = names["Params"](), sketch.links["AB"].points | sketch.links["BC"].points
    (ax, ay), (_, cy) = points["A"], points["C"]
    sol = m.sweep(steps=72)
    theta = sol.body("ab").theta
    assert sol.body("ab").omega == pytest.approx(-10 * math.tau / 60)  # 10 rpm clockwise
    rise = cy - ay - p.ab * np.sin(theta)
    x = ax + p.ab * np.cos(theta) + np.sqrt(p.bc**2 - rise**2)
    rod = sol.body("bc")
    np.testing.assert_allclose(rod.x + p.bc * np.cos(rod.theta), x, atol=1e-12)
    np.testing.assert_allclose(rod.y + p.bc * np.sin(rod.theta), cy, atol=1e-12)


def test_the_same_machine_moves_the_same_from_both_ages() -> None:
    """A yoke in a slot of a link and on a welded slider of the ground, as three records each and as one."""
    old, new = (built(ADDRESSES[name])[1].sweep(6.0, steps=60) for name in ("scotch_yoke", "scotch_yoke_2026"))
    np.testing.assert_allclose(old.body("cd").x, new.body("cd").x, atol=1e-12)
    np.testing.assert_allclose(old.body("cd").theta, new.body("cd").theta, atol=1e-12)
    crank = old.body("ab").theta
    np.testing.assert_allclose(old.body("cd").x, 0.01 * np.cos(crank), atol=1e-12)


def test_a_motor_at_a_floating_pin_turns_the_second_link_against_the_first() -> None:
    sketch, m, _ = built(ADDRESSES["oscillating_fan"])
    assert [(motor.first, motor.second) for motor in sketch.motors] == [("ACN", "CD")]
    sol = m.sweep(6.0, steps=60)
    turned = sol.body("cd").omega - sol.body("acn").omega
    np.testing.assert_allclose(turned, -10 * math.tau / 60, atol=1e-9)
    assert np.ptp(sol.body("acn").theta) < 3.0  # the head swings


def test_a_driven_cylinder_follows_the_law_of_cosines() -> None:
    sketch, m, names = built(ADDRESSES["cylinder_boom"])
    points = sketch.links["OC"].points | sketch.links["GN"].points
    (ox, oy), (gx, gy) = points["O"], points["G"]
    sol = m.sweep(0.02, steps=20)
    boom, length = sol.body("oc"), names["Params"]().oc
    tip = boom.x + length * np.cos(boom.theta), boom.y + length * np.sin(boom.theta)
    apart = np.hypot(tip[0] - gx, tip[1] - gy)
    np.testing.assert_allclose(apart - apart[0], 0.01 * sol.t, atol=1e-9)  # 1 cm/s
    cosine = (length**2 + (gx - ox) ** 2 + (gy - oy) ** 2 - apart**2) / (2 * length * math.hypot(gx - ox, gy - oy))
    np.testing.assert_allclose(np.cos(boom.theta - math.atan2(gy - oy, gx - ox)), cosine, atol=1e-9)


@pytest.mark.parametrize(
    ("choices", "unit", "kg"), [("0011", 0.0254, 0.45359237), ("1011", 0.01, 1e-3), ("2011", 1.0, 1.0)]
)
def test_lengths_and_masses_have_the_unit_of_the_address(choices: str, unit: float, kg: float) -> None:
    address = stamped(ADDRESSES["punch_press"].replace(",0.1011.", f",0.{choices}."))
    _, m, names = built(address)
    assert names["Params"]().crank == pytest.approx(1.2 * unit)
    assert m.bodies["crank"].mass == pytest.approx(2.0 * kg)
    assert m.bodies["block_c"].mass == pytest.approx(6.0 * kg)  # its block
    assert m.gravity == (0.0, -9.81)


def test_the_last_two_digits_are_62_and_63() -> None:
    """PMKS+ writes 62 as _ and 63 as -, which was read the other way round."""
    assert read(ADDRESSES["four_bar"]).links["AB"].points["B"] == pytest.approx((-0.02622, 0.00902))
    assert read(ADDRESSES["cylinder_boom"]).links["GN"].points["N"] == pytest.approx((0.01272, 0.02303))


def test_forces_are_fixed_in_the_world_or_turn_with_their_link() -> None:
    """The punch is pushed up by its work; the hook of a crane pulls down, the rope of its jib along with the jib."""
    sketch = read(ADDRESSES["punch_press"])
    (work,) = sketch.loads
    assert (work.link, work.force, work.angle, work.turns) == (
        "Connecting rod",
        400.0,
        pytest.approx(math.pi / 2),
        False,
    )
    assert work.place == pytest.approx((0.0, -0.034))
    hook, rope = read(ADDRESSES["crane_two_loads"]).loads
    assert (hook.angle, hook.turns, rope.turns) == (pytest.approx(-math.pi / 2), False, True)
    light = ADDRESSES["punch_press"].replace("Crank,VG,o,", "Crank,0,0,").replace("rod,ku,6G,", "rod,0,0,")
    m = built(stamped(light.replace("CP,CP,1Tm,", "CP,CP,0,")))[1]
    sol = m.sweep(steps=36)
    rod = sol.body("connecting_rod")
    slides = rod.vy + m.bodies["connecting_rod"].length * rod.omega * np.cos(rod.theta)
    np.testing.assert_allclose(sol.driver("motor A").effort * sol.body("crank").omega, -400.0 * slides, atol=1e-9)


def test_only_the_first_input_of_a_machine_drives_it() -> None:
    sketch = read(stamped(ADDRESSES["four_bar"].replace(".KD,D,", ".MD,D,")))
    assert [motor.name for motor in sketch.motors] == ["motor A"]
    assert sketch.left_out == ["input D: PMKS+ moves that machine by its input A"]


def test_features_that_cannot_be_exported_are_named() -> None:
    lone = stamped(
        ADDRESSES["four_bar"].replace(".GC,C,l1,WW,0.", ".GC,C,l1,WW,0.2X,X,1,1,0.").replace("B,C,,.", "B,C,X,,.")
    )
    assert read(lone).left_out == ["input X: it needs two links that meet there, and there are 1"]
    geared = stamped(ADDRESSES["four_bar"][:-1] + ".G1~eyJ9q")
    assert read(geared).left_out == ["its gears; m.gear_pair says them"]


def test_a_mark_corrects_a_number_that_thousandths_cannot_hold() -> None:
    exact = read(stamped(ADDRESSES["four_bar"][:-1] + ".JB,PJB~0~-2.6223456,PJA~3~2.5q"))
    assert exact.links["AB"].points["B"] == pytest.approx((-0.026223456, 0.00902))
    assert exact.motors[0].rate == pytest.approx(2.5 * math.tau / 60)
    faster = read(stamped(ADDRESSES["four_bar"][:-1] + ".PI~0~12.5q"))
    assert faster.motors[0].rate == pytest.approx(-12.5 * math.tau / 60)
    with pytest.raises(UserError, match="corrects a number that does not exist"):
        read(stamped(ADDRESSES["four_bar"][:-1] + ".PJB~7~1q"))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda text: text[:60], "its checksum is wrong: it was changed or cut off; copy all of it, in quotes"),
        (lambda text: stamped(text[:60]), "a list of its records does not end; copy all of it"),
        (lambda text: stamped(text[:15]), "5 of 7 sections are there"),
        (lambda text: text.replace("0e_", "0e-") + "*3AbCdE", "its digest is wrong"),
        (lambda text: stamped(text.replace("GB,B", "GA,B")), "there are two joints A"),
        (lambda text: stamped(text.replace(",A,B,,", ",A,Z,,")), "link AB has a joint Z, which does not exist"),
        (lambda text: stamped(text.replace("0mv", "0m+")), "'0m+' is not a number"),
        (lambda text: stamped(text.replace("0mv", "9" * 400)), "is not a number"),
        (lambda _: "pmks2:0123abcd.eyJ9", "a document of the new editor"),
    ],
)
def test_a_damaged_address_is_an_error(change, said: str) -> None:
    with pytest.raises(UserError) as refused:
        read("https://app.pmksplus.com/?" + change(ADDRESSES["four_bar"]))
    assert said in str(refused.value)
