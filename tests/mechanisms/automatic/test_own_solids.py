"""STEP files as the solids of links: holes that meet the pins, mass, and files that are none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cadquery as cq
import pytest

from mechanisms.automatic import automatic
from mechanisms.four_bar.mechanism import Params, build
from mechanisms.stages.automatic.own_solids import read_solid
from shared.stage.errors import UserError


@pytest.fixture(scope="module")
def made() -> Any:
    return automatic(build(Params()))


def plate(made: Any, moved: float = 0.0, narrower: float = 0.0, thicker: float = 0.0) -> cq.Workplane:
    """A coupler of an author's own: a wide plate with a window."""
    low, high = made.span("coupler")
    shape = cq.Workplane().rect(170, 60).extrude(high - low + thicker).translate((60, 10, 4.0))
    for x, y, eye in made.plan().eyes["coupler"]:
        scale = made.sizes.scale
        bore = cq.Workplane().circle(eye.bore * scale / 2 - narrower).extrude(80)
        shape = shape.cut(bore.translate((x * scale + moved, y * scale, -20)))
    return shape.cut(cq.Workplane().rect(10, 10).extrude(80).translate((30, 20, -20)))


def saved(shape: cq.Workplane, folder: Path) -> Path:
    cq.exporters.export(shape, str(folder / "own.step"))
    return folder / "own.step"


def test_a_solid_of_its_own_takes_the_place_of_a_plate(made: Any, tmp_path: Path) -> None:
    shape = plate(made)
    own = automatic(build(Params()))
    own.solid("coupler", saved(shape, tmp_path))
    piece = own.solids(engraved_too=False)["coupler"][0]
    low, _ = own.span("coupler")
    box = piece.shape.val().BoundingBox()
    assert piece.shape.val().Volume() == pytest.approx(shape.val().Volume(), rel=1e-6)  # pyright: ignore[reportAttributeAccessIssue]
    assert (box.zmin, box.xmin) == (pytest.approx(low, abs=1e-4), pytest.approx(-25.0, abs=1e-4))
    assert piece.through_holes == 4
    assert piece.name == made.solids(engraved_too=False)["coupler"][0].name


def test_holes_are_found_through_the_solid_alone(tmp_path: Path) -> None:
    block = cq.Workplane().box(40, 20, 8).faces(">Z").workplane().pushPoints([(-10, 0)]).hole(6)
    block = block.faces(">Z").workplane().pushPoints([(10, 0)]).hole(5, 4)  # blind
    block = block.union(cq.Workplane().circle(3).extrude(8).translate((0, 10, -4)))  # a round corner is no hole
    own = read_solid("four_bar", "coupler", saved(block, tmp_path))
    assert [(hole.x, hole.y, hole.radius) for hole in own.holes] == [(pytest.approx(-10), pytest.approx(0), 3.0)]
    assert (own.through_holes, own.thickness) == (1, pytest.approx(8.0))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"moved": 0.7}, "0.7 mm beside it. Move the hole, or the joint"),
        ({"narrower": 0.5}, "Widen it, or build with a thinner pin"),
        ({"thicker": 5.0}, "Make it thinner"),
    ],
)
def test_a_solid_that_does_not_fit_is_refused(made: Any, tmp_path: Path, given: Any, words: str) -> None:
    own = automatic(build(Params()))
    own.solid("coupler", saved(plate(made, **given), tmp_path))
    with pytest.raises(UserError, match=words):
        own.solids(engraved_too=False)


def test_files_that_are_no_solid_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="put the file beside"):
        read_solid("four_bar", "coupler", "missing.step")
    file = tmp_path / "bad.step"
    for content, words in (
        (b"", "is not a STEP file"),
        (b"\x00" * 999, "is not a STEP file"),
        (b"ISO-10303-21;\nHEADER;\n", "cannot be read|has no solid"),
    ):
        file.write_bytes(content)
        with pytest.raises(UserError, match=words):
            read_solid("four_bar", "coupler", file)
    two = cq.Workplane().box(5, 5, 5).union(cq.Workplane().box(5, 5, 5).translate((20, 0, 0)))
    with pytest.raises(UserError, match="2 solids"):
        read_solid("four_bar", "coupler", saved(two, tmp_path))
    with pytest.raises(UserError, match="units are wrong"):
        read_solid("four_bar", "coupler", saved(cq.Workplane().box(0.03, 0.02, 0.01), tmp_path))
    with pytest.raises(UserError, match="only faces or curves"):
        read_solid("four_bar", "coupler", saved(cq.Workplane().rect(5, 5).extrude(5).faces(">Z"), tmp_path))
