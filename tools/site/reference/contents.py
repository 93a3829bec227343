"""Which names are on which page of the reference."""

from __future__ import annotations

import importlib
import re
from typing import Any

from shared.stage.paths import ROOT

ROOMS: dict[str, tuple[str, tuple[str, ...]]] = {
    "mechanism.md": ("Mechanism", ("mbsd.mechanism",)),
    "elements.md": ("Bodies, joints, forces", ("mbsd.model.body", "mbsd.model.joint", "mbsd.model.force")),
    "laws.md": ("Laws and curves", ("mbsd.model.laws",)),
    "gas.md": ("Gas of engines", ("mbsd.model.cylinders",)),
    "events.md": ("Events", ("mbsd.model.event", "mbsd.dynamics")),
    "results.md": ("Results", ("mbsd.results", "mbsd.analyses", "mbsd.kinematics")),
    "pictures.md": ("Pictures", ("mbsd.pictures", "mbsd.drawing")),
    "design.md": (
        "Balancing, tolerances, derivatives, synthesis, studies",
        ("mbsd.balancing", "mbsd.tolerancing", "mbsd.derivatives", "mbsd.synthesis", "mbsd.studies"),
    ),
    "errors.md": ("Errors and warnings", ("mbsd.base",)),
}
"""Names of ``mbsd`` by the room in which they are made."""
CONSTANTS = "mbsd.model.body"
"""Where constants are listed, which do not say where they are made."""
DOORS = {
    "cams.md": ("mbsd.cams", "Cams"),
    "extend.md": ("mbsd.extend", "Kinds of your own"),
    "extend_integrators.md": ("mbsd.extend.integrators", "Integrators of your own"),
    "testing.md": ("mbsd.testing", "Tests of your own kinds"),
}
"""Modules beside ``mbsd`` whose names users import."""
MACHINES = "machines.md"
"""What the documents import from ``mbsd.machines``, which has no door of its own."""
PAGES = ("README.md", *ROOMS, *DOORS, MACHINES)
IMPORTED = re.compile(r"^from (mbsd\.machines[\w.]*) import (\([^)]*\)|[^\n]+)", re.MULTILINE)


def contents() -> dict[str, tuple[str, dict[str, Any]]]:
    """Title and names of every page. Raises ValueError where a public name is on none."""
    out, left = _of_rooms()
    if left:
        raise ValueError(f"no page of the reference has {', '.join(left)}; give their room to one (ROOMS)")
    for page, (module, title) in DOORS.items():
        door = importlib.import_module(module)
        out[page] = title, {name: getattr(door, name) for name in door.__all__}
    return out | {MACHINES: ("Engines and figures", _machines())}


def _of_rooms() -> tuple[dict[str, tuple[str, dict[str, Any]]], list[str]]:
    """The pages of the names of ``mbsd``, and the names that are on none."""
    mbsd = importlib.import_module("mbsd")
    left = {name: getattr(mbsd, name) for name in mbsd.__all__}
    out: dict[str, tuple[str, dict[str, Any]]] = {}
    for page, (title, rooms) in ROOMS.items():
        names = {name: value for name, value in left.items() if _made_in(value).startswith(rooms)}
        out[page] = title, names
        left = {name: value for name, value in left.items() if name not in names}
    return out, list(left)


def _made_in(value: Any) -> str:
    module = getattr(value, "__module__", None)
    return module if isinstance(module, str) else CONSTANTS


def _machines() -> dict[str, Any]:
    documents = "\n".join(path.read_text() for path in sorted((ROOT / "docs").glob("*.md")))
    return {
        name: getattr(importlib.import_module(module), name)
        for module, names in sorted(set(IMPORTED.findall(documents)))
        for name in sorted(re.findall(r"\w+", names))
    }
