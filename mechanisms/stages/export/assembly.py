"""STEP assemblies of the parts in a pose, and the times and formats that a user asks for."""

from __future__ import annotations

import re
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.stages.solve.skeleton_file import main_material
from shared.contract import BodyParts, Motion, Parts
from shared.contract.geometry import with_rods
from shared.contract.materials import MATERIALS
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.paths import Out

# The request of an export: a solved mechanism, the time of a pose, and its parts if there are some.


@dataclass(frozen=True)
class Wanted:
    """One export."""

    solution: Any
    time: float
    """Time of a pose (s)."""
    out: Out
    parts: Parts | None

    @property
    def row(self) -> int:
        """Number of the output nearest to the time."""
        return int(np.abs(self.solution.t - self.time).argmin())


# The solids as a STEP assembly in one pose (mm): a product for each body, its pieces below, with names and colours.
#
#     mechanism ─► body, where it is at the time ─► body/piece, as its author drew it
#
# Pieces of a body's main material have the body's colour in all pictures, others the ink of theirs.

MM = 1000.0
GROUND = "ground"
_TIMESTAMP = re.compile(rb"(FILE_NAME\([^)]*?,)'\d{4}-\d\d-\d\dT[^']*'")
_STYLED = b"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION("
_ENTITY = re.compile(rb"#(\d+) = (.*?);\n", re.DOTALL)
_REFERENCE = re.compile(rb"#(\d+)")
_DRAWN = ("band", "coil", "cylinder", "spiral", "cord")
"""Looks of what films draw between parts; see mbsd/model/joint.py."""


def step(wanted: Wanted) -> tuple[bytes, list[str]]:
    """Return the file's bytes, and what has no solid.

    Raises UserError where parts or their files are missing.
    """
    parts = _parts(wanted)
    motion = with_rods(to_motion(wanted.solution, parts, "", {}), parts)
    document = _Document(motion.mechanism)
    for name, body in parts.bodies.items():
        inks = _inks(motion, name, body)
        solids = {f"{name}/{piece}": (_read(wanted, solid.step), inks[piece]) for piece, solid in body.pieces.items()}
        document.add(name, solids, _pose(motion, name, wanted.row))
    return document.content(), [*(f"body '{name}' (no solid)" for name in parts.without_solids), *_drawn(motion)]


def _parts(wanted: Wanted) -> Parts:
    if wanted.parts is None:
        name = wanted.out.name
        raise UserError(
            f"{name}: {wanted.out.parts} is missing, and a STEP file is made of it; run {to_run('parts', name)}"
        )
    return wanted.parts


def _read(wanted: Wanted, file: str) -> Any:
    """Return the shape in a STEP file of the parts."""
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader

    path, reader = wanted.out.parts_folder / file, STEPControl_Reader()
    if not path.is_file() or reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        lacks = "cannot be read" if path.is_file() else "is missing"
        raise UserError(f"{wanted.out.name}: {path} {lacks}; delete {wanted.out.parts.name} beside it and run "
                        f"{to_run('parts', wanted.out.name)}")  # fmt: skip
    reader.TransferRoots()
    return reader.OneShape()


def _inks(motion: Motion, name: str, body: BodyParts) -> dict[str, str]:
    """Return the colour of each piece (``#rrggbb``)."""
    main = main_material(body)
    own = motion.bodies[name].colour if name in motion.bodies and body.spans is None else MATERIALS[main].ink
    return {
        piece: own if solid.material == main else MATERIALS[solid.material].ink for piece, solid in body.pieces.items()
    }


def _pose(motion: Motion, name: str, row: int) -> tuple[float, float, float]:
    """Return the place (mm) and angle (rad) of a body's frame."""
    if name == GROUND:
        return 0.0, 0.0, 0.0
    body = motion.bodies[name]
    return MM * body.x[row], MM * body.y[row], body.theta[row]


def _drawn(motion: Motion) -> list[str]:
    """Return names of what films draw without a part."""
    things = {"joint": motion.joints, "driver": motion.drivers, "force": motion.forces, "contact": motion.contacts}
    return [
        f"{what} '{name}' ({thing.kind}, no solid)"
        for what, group in things.items()
        for name, thing in group.items()
        if thing.look in _DRAWN and getattr(thing, "measures", "length") in ("length", "angle")
    ]


class _Document:
    """An assembly of the CAD kernel."""

    def __init__(self, name: str) -> None:
        from OCP.TCollection import TCollection_ExtendedString
        from OCP.TDocStd import TDocStd_Document
        from OCP.XCAFDoc import XCAFDoc_DocumentTool

        self._document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(self._document.Main())
        self._colours = XCAFDoc_DocumentTool.ColorTool_s(self._document.Main())
        self._root = self._shapes.NewShape()
        _call(self._root, name)

    def add(self, name: str, solids: dict[str, tuple[Any, str]], pose: tuple[float, float, float]) -> None:
        """Add a body with its solids by name, each with its colour, at a pose (mm, rad)."""
        body = self._shapes.NewShape()
        _call(body, name)
        for piece, (shape, ink) in solids.items():
            label = self._shapes.AddShape(shape, False)
            _call(label, piece)
            _call(self._shapes.AddComponent(body, label, _location(0.0, 0.0, 0.0)), piece)
            self._paint(label, ink)
        _call(self._shapes.AddComponent(self._root, body, _location(*pose)), name)

    def _paint(self, label: Any, ink: str) -> None:
        from OCP.Quantity import Quantity_ColorRGBA
        from OCP.XCAFDoc import XCAFDoc_ColorType

        colour = Quantity_ColorRGBA()
        Quantity_ColorRGBA.ColorFromHex_s(ink, colour)
        self._colours.SetColor(label, colour, XCAFDoc_ColorType.XCAFDoc_ColorGen)

    def content(self) -> bytes:
        """Return the file's bytes; when it was written is left out."""
        import cadquery  # noqa: F401  (it makes the kernel report failures alone)
        from OCP.STEPCAFControl import STEPCAFControl_Writer
        from OCP.STEPControl import STEPControl_StepModelType

        self._shapes.UpdateAssemblies()
        writer = STEPCAFControl_Writer()
        writer.SetColorMode(True)
        writer.SetNameMode(True)
        writer.Transfer(self._document, STEPControl_StepModelType.STEPControl_AsIs)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "assembly.step"
            writer.Write(str(path))
            content = path.read_bytes() if path.exists() else b""
        if not content.rstrip().endswith(b"END-ISO-10303-21;"):
            raise UserError("the CAD kernel could not write the STEP file; is the disk full?")
        content = _TIMESTAMP.sub(rb"\1'1970-01-01T00:00:00'", content, count=1)
        return with_ordered_styles(_in_letters_of_step(content))


def with_ordered_styles(content: bytes) -> bytes:
    """Return a STEP file with its styles, which stand last, in the order of the solids that they colour.

    The kernel writes them in the order of a map of addresses, which differs from run to run.
    """
    first = content.find(_STYLED)
    if first < 0:
        return content
    first = content.rfind(b"#", 0, first)
    end = content.rfind(b"ENDSEC;")
    styles = {int(number): text for number, text in _ENTITY.findall(content[first:end])}
    lowest = min(styles)

    def within(number: int) -> list[int]:
        return [int(other) for other in _REFERENCE.findall(styles[number])]

    def solids(number: int) -> list[int]:
        """Return the numbers before the styles that one of them leads to."""
        return sorted(solid for other in within(number) for solid in ([other] if other < lowest else solids(other)))

    numbers: dict[int, int] = {}

    def count(number: int) -> None:
        if number >= lowest and number not in numbers:
            numbers[number] = lowest + len(numbers)
            for other in within(number):
                count(other)

    roots = sorted((number for number, text in styles.items() if text.startswith(_STYLED)), key=solids)
    for number in (*roots, *styles):
        count(number)

    def renamed(reference: re.Match[bytes]) -> bytes:
        number = int(reference[1])
        return b"#%d" % numbers.get(number, number)

    lines = [b"#%d = %s;\n" % (numbers[number], _REFERENCE.sub(renamed, styles[number])) for number in numbers]
    return content[:first] + b"".join(lines) + content[end:]


def _in_letters_of_step(content: bytes) -> bytes:
    """Return letters beyond ASCII as ISO 10303-21 (6.4.3) has them; the kernel writes UTF-8."""

    def hexadecimal(letters: re.Match[str]) -> str:
        short = max(letters[0]) < "\U00010000"
        code = letters[0].encode("utf-16-be" if short else "utf-32-be").hex().upper()
        return f"\\X{2 if short else 4}\\{code}\\X0\\"

    return re.sub(r"[^\x00-\x7f]+", hexadecimal, content.decode()).encode()


def _call(label: Any, name: str) -> None:
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name

    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name, True))


def _location(x: float, y: float, angle: float) -> Any:
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location

    turn, move = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), angle)
    move.SetTranslation(gp_Vec(x, y, 0))
    return TopLoc_Location(move.Multiplied(turn))
