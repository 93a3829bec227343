"""One glTF animation: what nodes do at the times of data.json, straight lines between them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from render.glb.document import Document
from shared.contract import Motion

Array = NDArray[np.float64]
FEWER = 1440
"""Times of things whose shapes change, at most."""


class Animation:
    """Collects what is animated; of two times of data.json at an event it has one, because poses agree there."""

    def __init__(self, document: Document, motion: Motion) -> None:
        self._document = document
        time = (np.array(motion.time) - motion.time[0]).astype(np.float32)
        self.kept = np.flatnonzero(np.concatenate([[True], np.diff(np.maximum.accumulate(time)) > 0]))
        """Numbers of the times that it has."""
        self.fewer = self.kept[np.unique(np.linspace(0, len(self.kept) - 1, FEWER).round().astype(int))]
        """A selection of these, for what changes its shape."""
        self._time = time
        self._clocks: dict[int, int] = {}
        self._samplers: list[dict[str, Any]] = []
        self._channels: list[dict[str, Any]] = []

    def add(self, node: int, path: str, values: np.ndarray) -> None:
        """``values`` at the times ``kept``, or ``fewer``: translation, rotation, scale or weights of a node."""
        number = len(values)
        if number not in self._clocks:
            times = self.kept if number == len(self.kept) else self.fewer
            self._clocks[number] = self._document.array(self._time[times], bounds=True)
        flat = values.reshape(-1) if path == "weights" else values
        output = self._document.array(flat.astype(np.float32))
        self._samplers.append({"input": self._clocks[number], "output": output, "interpolation": "LINEAR"})
        self._channels.append({"sampler": len(self._samplers) - 1, "target": {"node": node, "path": path}})

    def place(self, node: int, place: Array, angle: Array) -> None:
        """Move a node to places (n, 3) (m), turned about z by angles (n,) (rad); without the clip it is where it
        begins.
        """
        turn = about_z(angle)
        self.add(node, "translation", place)
        self.add(node, "rotation", turn)
        thing = self._document.json["nodes"][node]
        thing["translation"] = place[0].astype(np.float32).tolist()
        thing["rotation"] = turn[0].astype(np.float32).tolist()

    def content(self) -> dict[str, Any]:
        """As it stands in the document."""
        return {"name": "motion", "samplers": self._samplers, "channels": self._channels}


def about_z(angle: Array) -> Array:
    """Quaternions (n, 4) of turns by angles (n,) about z (rad)."""
    half, zero = angle / 2, np.zeros(len(angle))
    return np.stack([zero, zero, np.sin(half), np.cos(half)], axis=1)
