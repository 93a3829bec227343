"""Box around a shape, found quickly: of curved faces from control points, so somewhat too large."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import cadquery as cq


def rough_box(shape: cq.Workplane) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and highest corner (3,) (mm).

    CadQuery's own box is a tight one, which takes a quarter of a second where faces are the outcome of many cuts.
    """
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.Add_s(shape.val().wrapped, box, False)
    numbers = np.array(box.Get())
    return numbers[:3], numbers[3:]


def rough_size(shape: cq.Workplane) -> float:
    """Return the diagonal of the :func:`rough_box` (mm)."""
    low, high = rough_box(shape)
    return float(np.linalg.norm(high - low))
