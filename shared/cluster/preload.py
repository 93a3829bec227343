"""What a worker loads when it starts: it remembers the sources that it was started with, whatever becomes of them."""

from __future__ import annotations

from shared.cluster.identity import identity

FRAMES = ("render", "shared")
"""Rooms that decide how a picture looks."""


def dask_setup(_: object) -> None:
    """Called by Dask with the worker."""
    identity(FRAMES)
