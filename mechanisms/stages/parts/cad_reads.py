"""Reports to a recorder the files that the CAD kernel opens on its own: STEP, IGES, BREP, STL and fonts.

The kernel is compiled, so Python does not notice these; its reading functions are replaced while parts.py runs.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from mbsd.dependencies.recorder import Recorder

READERS = (
    ("STEPControl", "STEPControl_Reader", "ReadFile"),
    ("STEPCAFControl", "STEPCAFControl_Reader", "ReadFile"),
    ("IGESControl", "IGESControl_Reader", "ReadFile"),
    ("BRepTools", "BRepTools", "Read_s"),
    ("BinTools", "BinTools", "Read_s"),
    ("RWStl", "RWStl", "ReadFile_s"),
    ("StlAPI", "StlAPI", "Read_s"),
    ("StlAPI", "StlAPI_Reader", "Read"),
    ("RWGltf", "RWGltf_CafReader", "Perform"),
    ("VrmlAPI", "VrmlAPI_CafReader", "Perform"),
    ("Font", "Font_FontMgr", "CheckFont"),
)
"""Module, class and function of OCP; a name that ends in ``_s`` is static."""


@contextmanager
def reported_cad_files(recorder: Recorder) -> Iterator[None]:
    """Count as read every file whose name the kernel's reading functions get in this block."""
    replaced: list[tuple[Any, str, Any]] = []
    try:
        for module, kind, function in READERS:
            owner = getattr(importlib.import_module(f"OCP.{module}"), kind)
            plain = getattr(owner, function)
            reporting = _reporting(plain, recorder)
            replaced.append((owner, function, vars(owner).get(function)))
            setattr(owner, function, staticmethod(reporting) if function.endswith("_s") else reporting)
        yield
    finally:
        for owner, function, plain in replaced:
            if plain is None:
                delattr(owner, function)
            else:
                setattr(owner, function, plain)


def _reporting(plain: Callable[..., Any], recorder: Recorder) -> Callable[..., Any]:
    def reporting(*arguments: Any, **options: Any) -> Any:
        for value in (*arguments, *options.values()):
            if hasattr(value, "ToCString"):
                value = value.ToCString()
            if isinstance(value, str):
                recorder.read(value)
        return plain(*arguments, **options)

    return reporting
