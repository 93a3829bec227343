"""Automatic parts of models at a scale: places go with the machine, pins and clearances with the printer."""

from __future__ import annotations

import re

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic, automatic
from mechanisms.stages.automatic.layout.sizes import LEAST, RUNNING, STANDARD, fit_at_scale, lengths_of, thin_pins
from mechanisms.stages.clearance.path import at_scale, what_shrinks
from mechanisms.stages.loading.wishes import scaling
from mechanisms.stages.solve.motion_file import to_motion
from shared.shapes.bodies import Bodies
from shared.shapes.standards import Fit
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.scale import Scale, scale_of
from tests.mechanisms.automatic.layouts import meets
from tools.models.linkages import four_bar

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


def at(scale: Scale | None, m: Mechanism | None = None, **words: object) -> Automatic:
    m = m or large()
    with scaling(scale):
        made = automatic(m, solution=m.sweep(1.0, 120), **words)
        made.levels  # noqa: B018
    return made


@pytest.mark.parametrize("text", ["1:4", "1:8", "1:12", "2:1"])
def test_pins_are_standard_and_can_be_printed(text: str) -> None:
    scale = scale_of(text)
    made = at(scale)
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
    assert at(Scale(1, 14)).sizes.finished_pin == LEAST
    assert at(Scale(1, 14)).sizes.pin > 1.2 * at(Scale(1, 4)).sizes.pin


def test_links_that_are_too_short_are_named_with_the_scale_that_would_do() -> None:
    with pytest.raises(UserError, match=r"'A' and 'B' on 'crank' becomes 6 mm, .* need 8\.25 mm; SCALE=1:14 is"):
        at(Scale(1, 20))
    assert at(Scale(1, 14)).levels
    with pytest.raises(UserError, match=r"SCALE=3:1 is the smallest"):
        at(Scale(1, 1), four_bar(0.009, 0.003, 0.009, 0.007))


def test_without_a_scale_sizes_are_those_of_the_machine() -> None:
    sizes = at(None).sizes
    assert (sizes.ratio, sizes.finished, sizes.finished_pin) == (1.0, sizes.scale, sizes.pin)


def test_a_printers_own_fit_counts_and_a_pin_goes_with_the_machine() -> None:
    made = at(AT, fit=Fit(running=0.5, press=0.2), pin=20.0)
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
