"""Spring with a damper between two places.

F = stiffness (length - l) - damping l'        l = |d|; it pushes the places apart
"""

from __future__ import annotations

from mbsd.spatial.model.body import Fixing, Place
from mbsd.spatial.model.entries import add_force, design_distance, ends_given, not_negative
from mbsd.spatial.model.force import Force, ForceKind, Push, register_force
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import distance

SPRING = register_force(
    ForceKind(
        "spring",
        lambda f: [Push(distance(f.i, f.j), f.params["stiffness"], f.params["length"], f.params["damping"])],
        example=lambda m, i, j: m.spring(
            "example", i, j, start=(0.1, 0.2, 0.3), end=(-0.2, 0.5, 0.8), stiffness=30.0, damping=2.0, length=0.2
        ),
        look="coil",
    )
)


@SPRING.adds
def spring(
    m: Model, name: str, first: Fixing, second: Fixing, start: Place | None = None, end: Place | None = None,
    stiffness: float = 0.0, damping: float = 0.0, length: float | None = None,
) -> Force:  # fmt: skip
    """A spring (N/m) with a damper (N s/m) from ``start`` on the first body to ``end`` on the second.

    Places are those of the world in the design pose (m). ``length`` (m) is its free length, that of the design pose if
    it is not given.
    """
    what = f"{m.name}: force '{name}'"
    i, j = ends_given(m, what, first, second, start, end)
    not_negative(what, stiffness=stiffness, damping=damping)
    length = design_distance(i, j) if length is None else length
    return add_force(m, SPRING, name, i, j, {"stiffness": stiffness, "damping": damping, "length": length})
