"""Words, fits and pins of automatic parts: what one may want otherwise."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic, automatic
from mechanisms.stages.automatic.layout.sizes import STANDARD, of_pin
from mechanisms.stages.parts_files import read_triangles, stl_bytes
from shared.shapes.solid import Solid
from shared.shapes.standards import CIRCLIPS, SHIM_OUTER, Fit, screw_length, screw_name
from shared.stage.errors import UserError
from tests.shared.shape_checks import checked


def arm(length: float = 0.16) -> Mechanism:
    """One bar on one pivot."""
    m = Mechanism("arm")
    bar = m.bar("arm", length, mass=0.1)
    m.revolute("A", m.ground.at(0, 0), bar.start)
    m.drive_angle("motor", bar, constant_rate(1.0))
    return m


def wished(pin: float | None = 8.0, fit: Fit | None = None, length: float = 0.16) -> Automatic:
    m = arm(length)
    return automatic(m, pin, m.sweep(1.0, 4), fit)


def radii(solid: Solid) -> np.ndarray:
    """Distances (mm) of a piece's corners from the pivot, which is at the origin."""
    corners = read_triangles(stl_bytes(solid.shape.val())).reshape(-1, 3)
    return np.hypot(corners[:, 0], corners[:, 1])


def named(made: Automatic) -> dict[str, Solid]:
    return {solid.name: solid for solids in made.solids().values() for solid in solids}


@pytest.mark.parametrize("running", [0.15, 0.4])
def test_pins_run_with_the_clearance_that_is_asked_for(running: float) -> None:
    fit = Fit(running=running, press=0.05, axial=0.6, seat=0.02)
    pieces = named(wished(fit=fit))
    assert 2 * radii(pieces["bushing_A_low"]).min() == pytest.approx(8.0 + running, abs=0.04)
    assert 2 * radii(pieces["pin_A"]).max() == pytest.approx(8.0, abs=1e-6)
    low, flange = pieces["washer_A_low"].shape.val().BoundingBox(), pieces["bushing_A_low"].shape.val().BoundingBox()
    assert flange.zmin - low.zmax == pytest.approx(0.6, abs=0.03)
    assert pieces["circlip_A"].buy == "circlip 8x0.8 DIN 471"


@pytest.mark.parametrize("pin", [4.0, 8.0, 20.0])
def test_a_fit_is_in_millimetres_however_thick_the_pins_are(pin: float) -> None:
    pieces = named(wished(pin, Fit(running=0.3), length=0.02 * pin))
    assert 2 * radii(pieces["bushing_A_low"]).min() == pytest.approx(pin + 0.3, abs=0.05)


@pytest.mark.parametrize(
    ("pin", "fit", "message"),
    [
        (0.0, None, "arm: pin is 0.0 mm; give a positive number"),
        (-8.0, None, "arm: pin is -8.0 mm"),
        (math.nan, None, "arm: pin is nan mm"),
        (8.0, Fit(running=-0.2), r"arm: fit\.running is -0\.2 mm"),
        (8.0, Fit(axial=math.inf), r"arm: fit\.axial is inf mm"),
    ],
)
def test_sizes_that_are_none_are_refused(pin: float, fit: Fit | None, message: str) -> None:
    with pytest.raises(UserError, match=message):
        wished(pin, fit)


@pytest.mark.parametrize("pin", STANDARD)
def test_what_is_bought_has_the_sizes_of_its_standard(pin: float) -> None:
    sizes = of_pin(pin)
    pivot, scale = sizes.pivot, sizes.scale
    assert bool(pivot.washer_buy) == (pin in SHIM_OUTER)
    assert bool(pivot.clip_buy) == (pin in CIRCLIPS)
    if pivot.washer_buy:
        size = f"{pin:g}x{pivot.washer * scale:g}x{pivot.washer_thickness * scale:g}"
        assert pivot.washer_buy == f"shim ring {size} DIN 988"
        assert pivot.washer <= 2 * sizes.hardware  # it stays within what was kept free for it
    if pivot.clip_buy:
        clip = CIRCLIPS[pin]
        assert scale * (pivot.pin - 2 * pivot.groove_depth) == pytest.approx(clip.groove)
        assert scale * pivot.groove(10.0).width == pytest.approx(clip.width)
        assert clip.width > clip.thickness


def test_published_sizes() -> None:
    """DIN 471: d1 = 8: s = 0.8, d2 = 7.6, m = 0.9; 20: 1.2, 19, 1.3. DIN 988: 8 x 14. ISO 4762: M3 from 5 to 30 mm."""
    assert (CIRCLIPS[8].thickness, CIRCLIPS[8].groove, CIRCLIPS[8].width) == (0.8, 7.6, 0.9)
    assert (CIRCLIPS[20].thickness, CIRCLIPS[20].groove, CIRCLIPS[20].width) == (1.2, 19.0, 1.3)
    assert SHIM_OUTER[8] == 14
    assert screw_length(3, 12.5) == 12
    assert screw_length(3, 4.9) is None
    assert screw_length(3, 500.0) == 30
    assert screw_length(7, 20.0) is None
    assert screw_name(3, 12) == "M3x12 socket head cap screw ISO 4762"
    assert screw_name(3, 11) == ""


def test_a_word_is_cut_into_the_upper_face() -> None:
    plain, made = wished(length=0.045), wished(length=0.045)
    made.engrave("arm", "A", (21.0, 0.0), height=5.0)
    marked, bare = named(made)["arm"], named(plain)["arm"]
    checked(marked.shape, marked.through_holes)
    cut = bare.shape.cut(marked.shape).val().BoundingBox()
    assert cut.zmax == pytest.approx(made.span("arm")[1], abs=0.01)
    assert cut.zmax - cut.zmin == pytest.approx(0.6, abs=0.02)
    assert (cut.xmin + cut.xmax) / 2 == pytest.approx(21.0, abs=0.1)
    assert cut.ymax - cut.ymin == pytest.approx(5.0 * 1.2, abs=0.2)


def test_words_that_cannot_be_are_refused() -> None:
    made = wished()
    with pytest.raises(UserError, match="arm: cannot engrave 'ö'; there are strokes for A"):
        made.engrave("arm", "Aö", (40.0, 0.0))
    with pytest.raises(UserError, match="there is no letter to engrave"):
        made.engrave("arm", "", (40.0, 0.0))
    with pytest.raises(UserError, match=r"there is no body 'amr' to shape.*did you mean 'arm'"):
        made.engrave("amr", "A", (40.0, 0.0))
    made.engrave("arm", "B", (40.0, 9.0))
    with pytest.raises(UserError, match=r"arm: 'B' at \(40, 9\) mm is not all on the upper face of 'arm'; move it"):
        made.solids()
    with pytest.raises(UserError, match="'arm' is engraved"):
        made.replace("arm", [])
