"""The parts stage: what it redoes, what it leaves, what it refuses."""

from __future__ import annotations

import math
import os
import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import cadquery as cq
import numpy as np
import pytest

from mechanisms.stages.loading.inputs import Inputs
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.parts.memory import traced
from mechanisms.stages.parts.meshes import check_mesh, mass_of, only_solid
from mechanisms.stages.parts_files import TOLERANCE, binary_stl, read_mesh, stl_bytes
from shared.contract import read_parts
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.facets import facets, volume_of
from shared.shapes.outline import circle, loop
from shared.shapes.solid import Solid, placed
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.paths import Out
from shared.stage.stages import Stage


@dataclass(frozen=True)
class Params:
    """Lengths in m, speed in rad/s."""

    crank: float = 0.040
    rocker: float = 0.090
    speed: float = 6.0

    @property
    def half(self) -> float:
        return self.crank / 2


def washer(name: str, x: float, holes: int = 1, material: str = "steel") -> Solid:
    shape = extruded(circle(0, 0, 8.0), 3.0, holes=[circle(0, 0, 4.0)])
    return Solid(name, placed(shape, x), material, holes)


def two_bodies(p: Any) -> dict[str, list[Solid]]:
    return {
        "ground": [washer("plate", 0.0)],
        "crank": [washer("crank", mm(p.crank)), washer("pin", 0.0, material="brass")],
        "rocker": [washer("rocker", mm(p.rocker))],
    }


class Bench:
    """The stage on parameters and solids of the test's own."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.params: Any = Params()
        self.parts: Any = two_bodies
        self.builds = 0
        monkeypatch.setattr(parts_stage, "params", lambda name: self.params)
        monkeypatch.setattr(parts_stage, "load", self._load)

    def _load(self, name: str, file: str) -> SimpleNamespace:
        self.builds += 1
        return SimpleNamespace(parts=self.parts)

    def run(self) -> dict[str, float]:
        """Run the stage; the time stamps of the files."""
        parts_stage.run("four_bar")
        folder = Out("four_bar").parts_folder
        for path in folder.iterdir():  # so that a file that is written again shows
            if path.stat().st_mtime > 1e9:
                os.utime(path, (1e9 + self.builds, 1e9 + self.builds))
        return {path.name: path.stat().st_mtime for path in folder.iterdir()}


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch, out_root: Path) -> Bench:
    return Bench(monkeypatch)


def test_nothing_changed_nothing_built(bench: Bench) -> None:
    bench.run()
    bench.run()
    assert bench.builds == 1
    assert parts_stage.are_current("four_bar")
    bench.params = replace(bench.params, crank=0.041)
    assert not parts_stage.are_current("four_bar")


def test_a_parameter_that_the_parts_do_not_read_redoes_nothing(bench: Bench) -> None:
    bench.run()
    bench.params = replace(bench.params, speed=1.0)
    bench.run()
    assert bench.builds == 1


def test_a_length_changes_what_follows_from_it_and_nothing_else(bench: Bench) -> None:
    bench.run()
    folder = Out("four_bar").parts_folder
    before = {path.name: (path.read_bytes(), path.stat().st_ino) for path in folder.iterdir()}
    bench.params = replace(bench.params, crank=0.050)
    bench.run()
    assert bench.builds == 2
    after = {path.name: (path.read_bytes(), path.stat().st_ino) for path in folder.iterdir()}
    assert {name for name in after if after[name] != before[name]} == {"crank.stl", "crank.step", "parts.json"}
    crank = read_parts(folder / "parts.json").bodies["crank"].pieces["crank"]
    assert crank.mass.com == pytest.approx((0.050, 0.0), abs=1e-9)


def test_solids_that_are_gone_leave_no_files(bench: Bench) -> None:
    bench.run()
    bench.params = replace(bench.params, rocker=0.091)  # so that the stage runs
    bench.parts = lambda p: {"ground": [washer("plate", 0.0)], "rocker": [washer("rocker", mm(p.rocker))]}
    assert set(bench.run()) == {"plate.stl", "plate.step", "rocker.stl", "rocker.step", "parts.json"}


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        (lambda p: {"ground": [washer("plate", 0.0, holes=2)]}, "ground: plate: Euler number 0 means 1 through holes"),
        (lambda p: {"ground": [washer("a", 0.0), washer("a", 9.0)]}, "both have a solid 'a'"),
        (lambda p: {"ground": [washer("a b", 0.0)]}, "a solid is called 'a b'; use letters, digits and _"),
        (lambda p: {"ground": [washer("a", 0.0, material="cheese")]}, "a is of 'cheese'; there is aluminium"),
        (lambda p: {"ground": []}, r"parts\(\)\['ground'\] must be a list of one Solid or more"),
        (lambda p: {}, r"parts\(\) must return a dict"),
        (
            lambda p: {"ground": [Solid("two", cq.Workplane().pushPoints([(0, 0), (9, 0)]).box(2, 2, 2), "steel", 0)]},
            "ground: two consists of 2 separate solids",
        ),
    ],
)
def test_wrong_parts_are_named(bench: Bench, parts: Any, message: str) -> None:
    bench.run()
    before = read_parts(Out("four_bar").parts)
    bench.parts, bench.params = parts, replace(bench.params, crank=0.041)
    with pytest.raises(UserError, match=message):
        bench.run()
    assert read_parts(Out("four_bar").parts) == before  # what was made stays


def test_a_mesh_that_is_off_in_volume_is_refused() -> None:
    solid = only_solid(washer("a", 0.0).shape, "a")
    mesh = read_mesh(stl_bytes(solid))
    with pytest.raises(UserError, match=r"a: its mesh has .* allowed 0.5%; a fillet has probably failed"):
        check_mesh(mesh, 1.01 * solid.Volume(), 1, "a")
    mesh.update_faces([True] * (len(mesh.faces) - 1) + [False])
    with pytest.raises(UserError, match="a: its mesh has 3 open edges"):
        check_mesh(mesh, solid.Volume(), 1, "a")


def test_faults_of_automatic_parts_are_no_faults_of_the_user() -> None:
    """Who wrote no CAD gets no advice on cones; edges at which more than two faces meet are counted, too."""
    boxes = cq.Workplane().box(2, 2, 2).union(cq.Workplane().box(2, 2, 2).translate((2, 2, 0)))
    solids = boxes.solids().vals()
    mesh = read_mesh(binary_stl(np.concatenate([facets(solid, 0.1, 0.3) for solid in solids])))
    for automatic in (True, False):
        with pytest.raises(UserError) as error:
            check_mesh(mesh, 16.0, 0, "anchor: roller", automatic)
        words = str(error.value)
        assert words.startswith("anchor: roller: its mesh has 1 edges at which more than two faces meet, it must be")
        assert ("fault of the program" in words) == automatic == ("avoid cone" not in words)
    with pytest.raises(UserError, match="consists of 2 separate solids, it must be one; mbsd shaped this part"):
        only_solid(cq.Workplane().pushPoints([(0, 0), (9, 0)]).box(2, 2, 2), "rod: rod", automatic=True)


def test_a_mesh_that_the_kernel_leaves_open_is_tried_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it loses a face depends on where it divides the edges."""
    solid, asked, plain = only_solid(washer("a", 0.0).shape, "a"), [], facets

    def torn(shape: Any, tolerance: float, angle: float) -> np.ndarray:
        asked.append(tolerance)
        return plain(shape, tolerance, angle)[: -1 if len(asked) < 5 else None]

    monkeypatch.setattr("mechanisms.stages.parts_files.facets", torn)
    check_mesh(read_mesh(stl_bytes(solid)), solid.Volume(), 1, "a")
    assert len(asked) == len(set(asked)) == 5


def test_an_edge_shorter_than_a_file_can_tell_leaves_the_mesh_watertight() -> None:
    """The two ends of the short side have one place in float32; a triangle on it was an open edge."""
    corners = [(2000.0, 0.0), (2010.00002, 0.0), (2010.00002, 10.0), (2010.0, 10.0), (2000.0, 9.0)]
    side = cq.Wire.makePolygon([cq.Vector(x, y, 0.0) for x, y in corners], close=True)
    solid = only_solid(extruded(side, 5.0), "plate")
    check_mesh(read_mesh(stl_bytes(solid)), solid.Volume(), 0, "plate")


@pytest.mark.parametrize("scale", [0.1, 1.0, 30.0])
def test_walls_along_a_spline_are_upright_and_as_fine_as_the_curve(scale: float) -> None:
    """Else one curved slot has 130 000 triangles, which no search for the least gap comes through."""
    angles = np.linspace(0.0, 2 * math.pi, 241)
    circle = 40.0 * scale * np.column_stack([np.cos(angles), np.sin(angles)])
    plate = extruded(outline.circle(0, 0, 60.0 * scale), 8.0 * scale)
    groove = extruded(loop(circle, 5.0 * scale), 5.0 * scale).cut(extruded(loop(circle, -5.0 * scale), 6.0 * scale))
    solid = only_solid(plate.cut(groove), "plate")
    mesh = read_mesh(stl_bytes(solid))
    check_mesh(mesh, solid.Volume(), 0, "plate")
    assert len(mesh.faces) < 12_000
    assert set(np.unique(np.round(mesh.vertices[:, 2] / scale, 3))) == {0.0, 5.0, 8.0}
    around = mesh.triangles[np.ptp(mesh.triangles[:, :, 2], axis=1) > 1e-3 * scale]
    middles = np.hypot(*np.moveaxis(around.mean(axis=1)[:, :2], -1, 0))  # chords stray from the curve here
    off = np.abs(middles[:, None] - scale * np.array([35.0, 45.0, 60.0])).min(axis=1)
    assert off.max() < 1.5 * TOLERANCE


@pytest.mark.parametrize("scale", [0.1, 1.0, 30.0])
def test_masses_of_solids_with_splines_are_exact(scale: float) -> None:
    """A disc whose rim is a spline through a circle, with a hole: the CAD kernel alone errs by percents along some."""
    angles = np.linspace(0.0, 2 * math.pi, 241)
    circle = scale * np.column_stack([np.cos(angles), np.sin(angles)])
    solid = only_solid(
        extruded(loop(circle, 40.0 * scale - scale), 8.0 * scale).cut(extruded(loop(circle, 9.0 * scale), 8.0 * scale)),
        "disc",
    )
    volume, mass = math.pi * (39.0**2 + 2 * 39.0 + 1 - 100.0) * 8.0 * scale**3, mass_of(solid, 1000.0)
    assert volume_of(solid) == pytest.approx(volume, rel=1e-6)
    assert mass.mass == pytest.approx(1e-6 * volume, rel=1e-6)
    assert mass.inertia == pytest.approx(1e-12 * volume * (40.0**2 + 10.0**2) * scale**2 / 2, rel=1e-6)
    assert mass.com == pytest.approx((0.0, 0.0), abs=1e-9 * scale)


def test_reads_of_parameters_are_seen_through_properties_and_asdict() -> None:
    stand_in, seen = traced(Params())
    assert isinstance(stand_in, Params)
    assert (stand_in.rocker, stand_in) == (0.090, stand_in)
    assert seen == {"rocker"}
    stand_in, seen = traced(Params())
    assert stand_in.half == 0.020
    assert seen == {"half", "crank"}
    stand_in, seen = traced(Params())
    assert asdict(stand_in) == asdict(Params())
    assert seen == {"crank", "rocker", "speed"}


def test_a_computed_parameter_makes_the_text_of_its_file_count(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """``half`` may be computed from anything, so all of mechanism.py is part of the key."""
    folder = tmp_path / "four_bar"
    folder.mkdir()
    (folder / "mechanism.py").write_text("class Params: ...\n")
    (folder / "parts.py").write_text("from .mechanism import Params\ndef parts(p: Params): ...\n")
    monkeypatch.setattr(parts_stage, "mechanism_file", lambda _, file="mechanism": folder / f"{file}.py")
    for module in [module for module in sys.modules if module.startswith("mechanisms.four_bar")]:
        monkeypatch.delitem(sys.modules, module)  # the real one, which an earlier test may have loaded
    nothing, by_hand = Inputs(), parts_stage._Wish(by_itself=False, mount=None)
    plain = parts_stage._key(Params(), ["crank"], nothing, by_hand)
    assert parts_stage._key(Params(speed=1.0), ["crank"], nothing, by_hand) == plain
    assert parts_stage._key(Params(crank=0.041), ["crank"], nothing, by_hand) != plain
    assert not parts_stage._more_than_values("four_bar", Params(), ["crank"])
    assert parts_stage._more_than_values("four_bar", Params(), ["crank", "half"])
    bench.run()
    notes = Stage(Out("four_bar"), "parts", "", []).notes()
    assert not [file for file in notes["inputs"]["modules"] if file.endswith("four_bar/mechanism.py")]
    bench.parts = lambda p: {"ground": [washer("plate", mm(p.half))]}
    bench.params = replace(bench.params, crank=0.050)
    bench.run()
    notes = Stage(Out("four_bar"), "parts", "", []).notes()
    assert [file for file in notes["inputs"]["modules"] if file.endswith("four_bar/mechanism.py")]
