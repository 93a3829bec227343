"""Automatic parts as a whole, what an author may wish otherwise, and devices where layers are short."""

from __future__ import annotations

import math
import re
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechanisms.stages.automatic.kinds  # noqa: F401  (enters them)
from mbsd import Mechanism, constant_rate
from mbsd.model import joint
from mbsd.model.force import FORCE_KINDS
from mechanisms.stages import shot as shot_stage
from mechanisms.stages.automatic.automatic import Automatic, automatic
from mechanisms.stages.automatic.layout import plan
from mechanisms.stages.automatic.layout.items import Item, Reach
from mechanisms.stages.automatic.layout.layers import Problem, find_layers
from mechanisms.stages.automatic.layout.motion import TURN, poses_of, times_of
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.layout.sizes import STANDARD, of_pin
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.clearance import stage as clearance_stage
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.parts_files import read_triangles, stl_bytes
from mechanisms.stages.solve import masses
from mechanisms.stages.solve import stage as solve_stage
from mechanisms.stages.solve.masses import bare_solution
from mechanisms.stages.solve.solving import CLOSE, swept_closely
from shared.contract import read_parts
from shared.contract.shot import Shot, read_shot
from shared.shapes.solid import Solid
from shared.shapes.standards import CIRCLIPS, SHIM_OUTER, Fit, screw_length, screw_name
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from tests.mechanisms.author_project import Project
from tests.mechanisms.automatic.proofs import meets
from tests.mechanisms.automatic.test_random_mechanisms import KINDS, SEED
from tests.shared.shape_checks import checked
from tools.hunt.case import drawn
from tools.hunt_parts import case
from tools.hunt_parts.outcome import BUILT
from tools.models.four_bars import model

# A folder with mechanism.py alone: parts, motion, clearance and shot, as a user's stages make them.


MECHANISM = (ROOT / "mechanisms" / "four_bar" / "mechanism.py").read_text().replace('"four_bar"', '"arm"')


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Project:
    """The gallery's four-bar as ``arm``, its mechanism.py alone."""
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "out"))
    made = Project(tmp_path, monkeypatch, parts_stage)
    (made.folder / "mechanism.py").write_text(MECHANISM)
    return made


def test_mechanism_alone_reaches_the_film(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    project.run()
    for stage in (solve_stage, clearance_stage, shot_stage):
        stage.run("arm")
    said = capsys.readouterr().out
    assert "none touch" in said
    out = Out("arm")
    parts = read_parts(out.parts)
    assert set(parts.bodies) == {"ground", "crank", "coupler", "rocker"}
    for body in ("crank", "coupler", "rocker"):
        assert next(iter(parts.bodies[body].pieces)) == body
    pieces = {name for body in parts.bodies.values() for name in body.pieces}
    assert {"base_plate", "pedestal_A", "pin_A", "circlip_A", "bushing_B_low", "washer_C", "stylus_P"} <= pieces
    assert read_shot(out.shot) == Shot()

    project.run()
    assert capsys.readouterr().out == "parts: arm: nothing to do\n"
    (project.folder / "mechanism.py").write_text(MECHANISM.replace("rocker: float = 0.090", "rocker: float = 0.095"))
    project.run()
    assert "solids of 4 bodies" in capsys.readouterr().out
    assert read_parts(out.parts).bodies["rocker"].mass.com[0] > parts.bodies["rocker"].mass.com[0]


def test_motion_goes_on_where_there_are_no_parts(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    """Where nobody knows a look, ``parts`` says so and ends; what needs no parts goes on with estimated masses."""
    (project.folder / "mechanism.py").write_text(ROCKET)
    with pytest.raises(UserError, match="arm: body 'flag' looks like 'rocket'; there is: "):
        project.run()
    parts_stage.run_or_none("arm")
    solve_stage.run("arm")
    said = capsys.readouterr()
    assert "until then there are none" in said.out + said.err
    assert "masses are estimated" in said.out + said.err


def test_bodies_that_cannot_pass_are_panes_of_glass(project: Project) -> None:
    (project.folder / "mechanism.py").write_text(HANDS)
    project.run()
    parts = read_parts(Out("arm").parts)
    assert parts.schematic.endswith("hand0, hand1 and hand2 cannot pass each other in layers")
    assert {"hand0", "hand1", "hand2"} <= parts.bodies.keys()


def test_a_short_parts_file_changes_what_it_likes(project: Project) -> None:
    (project.folder / "mechanism.py").write_text(ARM)
    (project.folder / "parts.py").write_text(CHANGED)
    project.run()
    bodies = read_parts(Out("arm").parts).bodies
    arm = bodies["arm"].pieces
    assert set(arm) == {"stick"}
    assert arm["stick"].material == "pla_orange"
    assert bodies["ground"].pieces["pin_A"].z_range[1] > arm["stick"].z_range[1]
    assert arm["stick"].z_range[0] > 0.008  # above its pedestal


def test_parts_of_a_variant_follow_from_the_motion_of_the_variant(
    project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def solved(name: str) -> Any:
        asked.append(name)
        return bare_solution(name)

    monkeypatch.setattr(masses, "bare_solution", solved)
    (project.folder / "mechanism.py").write_text(ARM + 'VARIANTS = {"long": {"length": 0.2}}\n')
    (project.folder / "parts.py").write_text(CHANGED)
    project.run()
    parts_stage.run("arm-long")
    assert asked == ["arm", "arm-long"]


ARM = """
from dataclasses import dataclass

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    length: float = 0.16


def build(p: Params) -> Mechanism:
    m = Mechanism("arm")
    arm = m.bar("arm", p.length)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_angle("motor", arm, constant_rate(1.0))
    return m
"""
ROCKET = ARM.replace(
    "    m.drive_angle",
    '    flag = m.body("flag", mass=0.1, inertia=1e-5, looks="rocket")\n'
    '    m.revolute("B", arm.end, flag.origin)\n    m.drive_angle("wind", flag, constant_rate(2.0))\n    m.drive_angle',
)
HANDS = """
from dataclasses import dataclass

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    apart: float = 0.03


def build(p: Params) -> Mechanism:
    m = Mechanism("arm")
    for k in range(3):
        hand = m.bar(f"hand{k}", 0.1)
        m.revolute(f"O{k}", m.ground.at(p.apart * k, 0), hand.start)
        m.drive_angle(f"motor{k}", hand, constant_rate(6.0, k))
    return m
"""
CHANGED = """
import cadquery as cq

from mechanisms.arm.mechanism import Params, build
from mechanisms.stages.automatic.automatic import automatic
from shared.shapes.solid import Solid
from shared.shapes.units import mm


def parts(p: Params) -> dict[str, list[Solid]]:
    made = automatic(build(p))
    low, high = made.span("arm")
    bar = cq.Workplane(origin=(mm(p.length) / 2, 0, low)).box(mm(p.length) + 20, 16, high - low, (True, True, False))
    made.replace("arm", [Solid("stick", bar.faces(">Z").workplane(origin=(0, 0, 0)).hole(9.0), "pla_orange", 1)])
    return made.solids()
"""


# Words, fits and pins of automatic parts: what one may want otherwise.


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


# What lets links pass that bars on pedestals do not: pivots sunk into their link, cranks of two webs.


SUNK, WEBS = 46, 73


@cache
def planned(number: int) -> Automatic:
    """Return the plan of one of the hundred random mechanisms."""
    _, subject, _ = drawn(SEED + number, KINDS[number % len(KINDS)])
    return Automatic(subject.m, case.moved(subject, steps=120))


def test_a_block_passes_over_a_pivot_that_is_sunk_into_its_guide() -> None:
    automatic = planned(SUNK)
    (pivot,) = (pin for pin in automatic.layout.select(Pin) if pin.is_flush(automatic.decided, automatic.layout))
    (guide,) = pivot.movers
    assert not meets(automatic)
    solids = automatic.plan().solids
    top = automatic.heights.top(guide)
    (shaft,) = (solid for solid in solids["ground"] if solid.name == f"pin_{pivot.name}".replace(" ", "_"))
    assert top - 0.5 < shaft.shape.val().BoundingBox().zmax < top
    assert not any(solid.name.startswith(f"circlip_{pivot.name}") for solid in solids["ground"])


def test_a_crank_of_two_webs_carries_a_rod_on_either_side() -> None:
    automatic = planned(WEBS)
    assert not meets(automatic)
    ((web, body),) = automatic.layout.webs.items()
    (joining,) = (pin for pin in automatic.layout.select(Pin) if pin.webs)
    between = [automatic.levels[b] for b in joining.movers if b not in (web, body)]
    low, high = sorted((automatic.levels[web], automatic.levels[body]))
    assert low < min(between) <= max(between) < high
    for other in (pin for pin in automatic.layout.select(Pin) if pin is not joining):
        assert not {web, body} <= set(other.places), "no other pin is on both"
    (pin,) = (
        solid
        for solids in automatic.plan().solids.values()
        for solid in solids
        if solid.name == f"pin_{joining.name}".replace(" ", "_")
    )
    box, ends = pin.shape.val().BoundingBox(), sorted((web, body), key=automatic.levels.__getitem__)
    assert automatic.heights.bottom(ends[0]) < box.zmin
    assert box.zmax < automatic.heights.top(ends[1])


def test_a_sunk_pivot_is_built_and_proven() -> None:
    outcome = case.run(SEED + SUNK, KINDS[SUNK % len(KINDS)]).outcomes[-1]
    assert outcome.state == BUILT, outcome


def test_a_crank_of_two_webs_is_sound() -> None:
    automatic = planned(WEBS)
    (body,) = automatic.layout.webs.values()
    crank = {body: automatic.solids(engraved_too=False)[body]}
    assert [solid.name for solid in crank[body]].count(body) == 1
    assert f"{body}_2" in [solid.name for solid in crank[body]]
    assert not case.overlapping(case.meshed(crank))  # pyright: ignore[reportArgumentType]


def test_a_body_between_two_others() -> None:
    names = ("a", "b", "c")
    items = [Item(name, name, disc(0.0, 0.0, 1.0), Reach((name,))) for name in names]
    pairs = [(i, j) for j in range(3) for i in range(j)]
    for low, high, middle in (("a", "b", "c"), ("b", "c", "a"), ("a", "c", "b")):
        layers = find_layers(Problem(names, items, pairs, between=[(low, high, (middle,))]))
        assert layers is not None
        assert layers[middle] == 1
    assert find_layers(Problem(names, items, pairs, {"a": 0}, between=[("b", "c", ("a",))])) is None


def test_poses_are_close_where_a_link_flies_past_its_dead_point() -> None:
    _, subject, _ = drawn(SEED + 36, KINDS[36 % len(KINDS)])
    solution = subject.m.sweep(subject.turn, 360)
    turned = np.abs(np.diff(solution.body("guide").theta)).max()
    assert turned > 4 * TURN, "else there is nothing to see"
    poses, times = poses_of(solution, 1.0), times_of(solution)
    assert len(poses["guide"]) == len(times)
    assert np.abs(np.diff(poses["guide"][:, 2])).max() < turned / 8
    assert (np.diff(times) > 0).all()


def test_sweeps_are_told_closely() -> None:
    _, subject, _ = drawn(SEED + 46, KINDS[46 % len(KINDS)])
    times = np.linspace(0.0, subject.turn or 1.0, 31)
    close = swept_closely(subject.m, times)
    assert set(times) < set(close.t)
    middles = (close.t[:-1] + close.t[1:]) / 2
    both = subject.m.sweep(times=np.unique(np.concatenate([close.t, middles])))
    h, at = np.diff(close.t)[:, None, None], np.arange(len(middles))
    q, v, a = close.q, close.v, close.a
    between = (q[at] + q[at + 1]) / 2 + 5 / 32 * h * (v[at] - v[at + 1]) + h * h / 64 * (a[at] + a[at + 1])
    size = close.packed.size
    off = np.abs(between - both.q[1::2]) * np.array([1.0, 1.0, size])
    assert off.max() <= CLOSE * size
    usual = np.linspace(0.0, 2 * np.pi, 361)
    assert np.array_equal(swept_closely(model((0.1, 0.04, 0.12, 0.1)), usual).t, usual)


# docs/parts.md says for every kind what it becomes, and of those that become nothing that they do not.


STOPS = {"angle_stop", "coordinate_stop"}
"""They are looked for by the joints whose way they end (layout/motion.py)."""


def _rows() -> tuple[set[str], set[str]]:
    """Names in the table's rows, and in those of what has no parts."""
    table = (ROOT / "docs" / "parts.md").read_text().split("## Automatic parts")[1].split("\n## ")[0]
    rows = [line for line in table.splitlines() if line.startswith("|")]
    without = [line for line in rows if "without parts |" in line]
    made = [line.split("|")[1] for line in rows if line not in without]
    return tuple({name for line in lines for name in re.findall(r"`(\w+)`", line)} for lines in (made, without))  # pyright: ignore[reportReturnType]


def test_every_kind_is_told_as_what_it_becomes() -> None:
    made, without = _rows()
    entered = {*plan.KINDS, *plan.DRIVER_KINDS, *plan.FORCE_KINDS, *plan.CONTACT_KINDS}
    every = {*joint.KINDS, *FORCE_KINDS, *joint.CONTACT_KINDS}
    assert made & every == (entered | STOPS) & every
    assert without & every == every - entered - STOPS
