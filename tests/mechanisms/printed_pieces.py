"""Solids of every sort that the print stage tells apart, and its run on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace

import cadquery as cq
import pytest

from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.print import stage as print_stage
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye, link
from shared.shapes.pin import Head, pin, washer
from shared.shapes.solid import Solid, placed
from shared.stage.paths import Out

SCREW = "M3x12 socket head cap screw ISO 4762"


def plate() -> cq.Workplane:
    """100 x 60 x 8 mm with two holes of 6 mm: a sheet."""
    holes = [outline.circle(15.0, 15.0, 3.0), outline.circle(85.0, 45.0, 3.0)]
    return extruded(outline.rounded_rectangle(0.0, 0.0, 100.0, 60.0, 8.0), 8.0, holes=holes)


def arm() -> cq.Workplane:
    """A link of 60 mm with a boss that stands 4 mm above its 7 mm."""
    return link(60.0, 7.0, Eye(13.0, 8.0), Eye(12.5, 8.0, above=4.0, boss=9.5), (17.0, 15.0), fillet=9.0)


def corner(mirrored: bool) -> cq.Workplane:
    """An L with a stud on one leg: not its own mirror image in any pose."""
    shape = cq.Workplane().box(40, 10, 5, (False, False, False)).union(cq.Workplane().box(10, 25, 5, (False,) * 3))
    shape = shape.union(placed(cq.Workplane().cylinder(6, 3, centered=(True, True, False)), 33.0, 5.0, 5.0))
    return shape.mirror("YZ") if mirrored else shape


def solids(bar: float = 150.0) -> dict[str, list[Solid]]:
    """By body; ``bar`` is the length of the longest piece (mm)."""
    bolt = pin(3.0, 12.0, Head(5.5, 3.0))
    over = arm().rotate((0, 0, 0), (1, 0, 0), 180)
    headed = pin(8.0, 30.0, Head(14.0, 4.0, 1.6))
    return {
        "ground": [
            Solid("plate", placed(plate(), 5.0, -3.0, -8.0), "aluminium", 2),
            *(Solid(f"screw_{k}", placed(bolt, 20.0 * k), "steel", 0, buy=SCREW) for k in range(3)),
        ],
        "crank": [
            Solid("crank", placed(arm(), 10.0, 0.0, 4.0, 30.0), "aluminium_orange", 2),
            Solid("pin", placed(headed, 60.0, 0.0, 4.0), "brass", 0),
            Solid("left", placed(corner(False), 0.0, 0.0, 30.0), "steel", 0),
            Solid("right", placed(corner(True), 0.0, 50.0, 30.0), "steel", 0),
        ],
        "coupler": [
            Solid("bar", cq.Workplane().box(bar, 12, 6), "steel", 0),
            Solid("torus", cq.Workplane(obj=cq.Solid.makeTorus(9.0, 3.0)), "brass", 1),
            Solid("spare", placed(over, 0.0, 90.0, 40.0, 77.3), "aluminium_orange", 2),
            Solid("ring", placed(washer(8.2, 14.0, 2.0), z=9.0), "bronze", 1),
        ],
    }


@dataclass(frozen=True)
class Params:
    """The solids follow from nothing."""


class Press:
    """parts.json of the solids given, and the print stage on it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.parts: Callable[[], dict[str, list[Solid]]] = solids
        monkeypatch.setattr(parts_stage, "params", lambda name: Params())
        monkeypatch.setattr(parts_stage, "load", lambda name, file: SimpleNamespace(parts=lambda p: self.parts()))
        self.out = Out("four_bar")

    def make(self) -> None:
        """The parts."""
        parts_stage.run("four_bar")

    def run(self, **words: str) -> dict[str, bytes]:
        """The files that the print stage leaves."""
        print_stage.run("four_bar", **words)
        return {path.name: path.read_bytes() for path in sorted(self.out.print_folder.iterdir())}
