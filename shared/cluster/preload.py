"""What a worker loads when it starts: it remembers the sources that it was started with, whatever becomes of them."""

from __future__ import annotations

from shared.cluster.identity import PACKAGES, identity

FRAMES = ("render", "shared")
"""Rooms that decide how a picture looks."""
PARTS = (
    *("mbsd", "shared", "mechanisms/stages"),
    *(f"mechanisms/{name}.py" for name in ("__init__", "__main__", "automatic")),
)
"""Rooms that decide what solids a mechanism gets, without what authors write."""
OF_PARTS = (
    *("cadquery", "cadquery-ocp", "distributed", "llvmlite", "msgspec", "numba", "numpy", "python-sat", "scipy"),
    "trimesh",
)
"""Packages that decide it, and how machines speak with each other."""


def dask_setup(_: object) -> None:
    """Called by Dask with the worker."""
    identity(FRAMES, PACKAGES)
    identity(PARTS, OF_PARTS)
