"""STEP, read back by the CAD kernel: solids have their names and colours and stand where their bodies are."""

from __future__ import annotations

import math
import re
from itertools import product
from pathlib import Path
from typing import Any

import cadquery as cq
import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.export.assembly import Wanted, step, with_ordered_styles
from mechanisms.stages.parts.bodies import described_body
from mechanisms.stages.solve.motion_file import to_motion
from shared.contract import Parts, Provenance
from shared.contract.geometry import with_rods
from shared.contract.materials import MATERIALS
from shared.shapes.solid import Solid
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import Out

BOXES = {
    "ground": {"base": ((-20, -30, -5), (160, 10, 0), "aluminium_black")},
    "crank": {"disc": ((-5, -5, 2), (45, 5, 8), "aluminium_orange"), "pin": ((38, -2, 0), (42, 2, 12), "steel")},
    "rocker": {"ärm ж": ((-5, -5, 2), (95, 5, 8), "aluminium_blue")},
    "link": {"rod": ((-4, -4, 12), (124, 4, 16), "aluminium")},
}
"""Corners (mm) and material of the pieces; the link is no body of the model but a rod between two places."""
ROD = (("crank", 40.0, 0.0), ("rocker", 90.0, 0.0))


@pytest.fixture(scope="module")
def solution() -> Any:
    m = Mechanism("crane")
    crank, rocker = m.bar("crank", 0.04, mass=0.1), m.bar("rocker", 0.09, mass=0.2)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("D", m.ground.at(0.12, 0), rocker.start)
    m.distance("link", crank.end, rocker.end, 0.12)
    m.spring("pull", m.ground.at(0, 0.1), rocker.end, 20.0)
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=0, rocker=100)
    return m.sweep(1.0, steps=100)


@pytest.fixture
def out(out_root: Path) -> Out:
    return Out("crane")


@pytest.fixture
def parts(out: Out) -> Parts:
    """Files stand where the stage would write them."""
    files: dict[str, bytes] = {}
    bodies = {
        body: described_body("crane", body, _solids(body), files, ROD if body == "link" else None) for body in BOXES
    }
    for file, content in files.items():
        write_bytes(out.parts_folder / file, content)
    return Parts(mechanism="crane", provenance=Provenance(inputs="0" * 64, versions={}), bodies=bodies)


def _solids(body: str) -> list[Solid]:
    return [
        Solid(piece, cq.Workplane().box(*np.subtract(high, low).tolist(), centered=False).translate(low), material, 0)
        for piece, (low, high, material) in BOXES[body].items()
    ]


@pytest.mark.parametrize("time", [0.0, 0.13, 0.5])
def test_solids_stand_where_the_motion_has_their_bodies(solution: Any, out: Out, parts: Parts, time: float) -> None:
    boxes, _ = _read(step(Wanted(solution, time, out, parts))[0], out.folder)
    motion = with_rods(to_motion(solution, parts, "", {}), parts)
    row = int(np.abs(solution.t - time).argmin())
    for body, pieces in BOXES.items():
        frame = motion.bodies.get(body)
        x, y, theta = (frame.x[row], frame.y[row], frame.theta[row]) if frame else (0.0, 0.0, 0.0)
        c, s = math.cos(theta), math.sin(theta)
        for piece, (low, high, _) in pieces.items():
            corners = np.array(list(product(*zip(low, high, strict=True))), float)
            turned = corners @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]]) + [1000 * x, 1000 * y, 0]
            expected = np.array([turned.min(axis=0), turned.max(axis=0)])
            assert boxes[f"{body}/{piece}"] == pytest.approx(expected, abs=1e-6)


def test_names_and_colours_are_those_of_all_pictures(solution: Any, out: Out, parts: Parts) -> None:
    content, left_out = step(Wanted(solution, 0.0, out, parts))
    boxes, colours = _read(content, out.folder)
    assert list(boxes) == [f"{body}/{piece}" for body, pieces in BOXES.items() for piece in pieces]
    motion = to_motion(solution, parts, "", {})
    assert colours == {
        "ground/base": MATERIALS["aluminium_black"].ink,
        "crank/disc": motion.bodies["crank"].colour,
        "crank/pin": MATERIALS["steel"].ink,
        "rocker/ärm ж": motion.bodies["rocker"].colour,
        "link/rod": MATERIALS["aluminium"].ink,
    }
    assert left_out == ["force 'pull' (spring, no solid)"]
    assert content.isascii()


def _styled(solids: list[int]) -> bytes:
    """A STEP file that colours these solids in this order, those with even numbers black; a colour stands where it is
    first used.
    """
    lines, colours = ["#1 = SOLID();", "#2 = SOLID();", "#3 = SOLID();", "#4 = SOLID();"], dict[int, int]()
    for solid in solids:
        number = len(lines) + 1
        red = 1 - solid % 2
        shown = colours.setdefault(red, number + 2)
        lines += [
            f"#{number} = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(\n    #{number + 1}),#{solid});"
        ]
        lines += [f"#{number + 1} = STYLED_ITEM('color',(#{shown}),#{solid});"]
        lines += [f"#{shown} = COLOUR_RGB('',{red}.,0.,0.);"] * (shown == number + 2)
    return "\n".join(["DATA;", *lines, "ENDSEC;", "END-ISO-10303-21;", ""]).encode()


@pytest.mark.parametrize("order", [[1, 2, 3, 4], [4, 3, 2, 1], [2, 4, 1, 3], [3, 1, 4, 2]])
def test_styles_are_in_the_order_of_their_solids(order: list[int]) -> None:
    """The kernel writes them in the order of addresses."""
    assert with_ordered_styles(_styled(order)) == _styled([1, 2, 3, 4])


def test_the_styles_of_a_file_are_all_there_in_their_order(solution: Any, out: Out, parts: Parts) -> None:
    content, _ = step(Wanted(solution, 0.0, out, parts))
    coloured = [int(solid) for solid in re.findall(rb"STYLED_ITEM\('color',\([^)]*\),#(\d+)\)", content)]
    assert len(coloured) == sum(map(len, BOXES.values()))
    assert coloured == sorted(coloured)
    assert with_ordered_styles(content) == content


def test_lengths_are_millimetres(solution: Any, out: Out, parts: Parts) -> None:
    assert b"SI_UNIT(.MILLI.,.METRE.)" in step(Wanted(solution, 0.0, out, parts))[0]


def test_missing_parts_are_refused_with_what_makes_them(solution: Any, out: Out, parts: Parts) -> None:
    with pytest.raises(UserError, match=r"parts\.json is missing.*run make parts-crane"):
        step(Wanted(solution, 0.0, out, None))
    (out.parts_folder / parts.bodies["crank"].pieces["pin"].step).unlink()
    with pytest.raises(UserError, match=r"pin\.step is missing; delete parts\.json.*run make parts-crane"):
        step(Wanted(solution, 0.0, out, parts))


def _read(content: bytes, folder: Path) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """By name: the box (2, 3) of each solid where the assembly has it (mm), and its colour."""
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDF import TDF_Label, TDF_LabelSequence
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

    path = folder / "read.step"
    write_bytes(path, content)
    document, reader = TDocStd_Document(TCollection_ExtendedString("XmlOcaf")), STEPCAFControl_Reader()
    reader.ReadFile(str(path))
    reader.Transfer(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    boxes: dict[str, np.ndarray] = {}
    colours: dict[str, str] = {}

    def walk(label: Any, location: Any) -> None:
        parts = TDF_LabelSequence()
        XCAFDoc_ShapeTool.GetComponents_s(label, parts)
        for part in (parts.Value(k) for k in range(1, parts.Length() + 1)):
            here, of = location.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(part)), TDF_Label()
            XCAFDoc_ShapeTool.GetReferredShape_s(part, of)
            if XCAFDoc_ShapeTool.IsAssembly_s(of):
                walk(of, here)
            else:
                shape = XCAFDoc_ShapeTool.GetShape_s(of)
                boxes[_name(of)], colours[_name(of)] = _box(shape.Located(here)), _colour(document, shape)

    from OCP.TopLoc import TopLoc_Location

    roots = TDF_LabelSequence()
    shapes.GetFreeShapes(roots)
    assert [_name(roots.Value(k)) for k in range(1, roots.Length() + 1)] == ["crane"]
    walk(roots.Value(1), TopLoc_Location())
    return boxes, colours


def _name(label: Any) -> str:
    from OCP.TDataStd import TDataStd_Name

    name = TDataStd_Name()
    assert label.FindAttribute(TDataStd_Name.GetID_s(), name)
    return name.Get().ToExtString()


def _box(shape: Any) -> np.ndarray:
    vertices = [vertex.toTuple() for vertex in cq.Shape.cast(shape).Vertices()]
    return np.array([np.min(vertices, axis=0), np.max(vertices, axis=0)])


def _colour(document: Any, shape: Any) -> str:
    from OCP.Quantity import Quantity_Color
    from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool

    colour = Quantity_Color()
    tool = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    kinds = (XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen)
    assert any(tool.GetColor(shape, kind, colour) for kind in kinds)
    return Quantity_Color.ColorToHex_s(colour, True).ToCString().lower()
