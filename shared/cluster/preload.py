"""Setup of scheduler and workers: no HTTP server, and workers remember the sources of their start."""

from __future__ import annotations

from typing import Any

from shared.cluster.identity import PACKAGES, identity

FRAMES = ("render", "shared", "mbsd/base", "mbsd/dealing")
"""Rooms that decide how a picture looks, and how machines speak with each other."""
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


def dask_setup(server: Any) -> None:
    """Prepare the scheduler or the worker, which then listens on its own address alone. Dask calls it.

    Dask's HTTP server shows logs to whoever asks and passes requests on to other machines, so it is closed.
    """
    server.http_server.stop()
    if hasattr(server, "nthreads"):  # a worker, which may be asked after its sources have changed
        identity(FRAMES, PACKAGES)
        identity(PARTS, OF_PARTS)
