"""One glTF animation: what nodes do at the times of data.json, straight lines between them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from render.glb.document import Document
from shared.contract import Motion

Array = NDArray[np.float64]
FEWER = 1440
"""Times of things whose shapes change, at most."""


class Track(NamedTuple):
    """What one node does, as accurate as data.json."""

    node: int
    path: str
    """translation (m), angle about z (rad), scale, or weights of shapes."""
    values: Array
    """(T, ...) at the times ``kept`` or ``fewer``."""


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
        self.tracks: list[Track] = []
        """The same for other formats."""
        self._clocks: dict[int, int] = {}
        self._samplers: list[dict[str, Any]] = []
        self._channels: list[dict[str, Any]] = []

    def rows(self, values: np.ndarray) -> NDArray[np.intp]:
        """Numbers of the times of values."""
        return self.kept if len(values) == len(self.kept) else self.fewer

    def add(self, node: int, path: str, values: np.ndarray) -> None:
        """``values`` at the times ``kept``, or ``fewer``: translation, scale or weights of a node."""
        self.tracks.append(Track(node, path, values))
        self._sample(node, path, values)

    def turn(self, node: int, angle: Array) -> np.ndarray:
        """Turn a node about z by angles (n,) (rad); returns the quaternions (n, 4)."""
        self.tracks.append(Track(node, "angle", angle))
        turn = about_z(angle)
        self._sample(node, "rotation", turn)
        return turn

    def _sample(self, node: int, path: str, values: np.ndarray) -> None:
        number = len(values)
        if number not in self._clocks:
            self._clocks[number] = self._document.array(self._time[self.rows(values)], bounds=True)
        flat = values.reshape(-1) if path == "weights" else values
        output = self._document.array(flat.astype(np.float32))
        self._samplers.append({"input": self._clocks[number], "output": output, "interpolation": "LINEAR"})
        self._channels.append({"sampler": len(self._samplers) - 1, "target": {"node": node, "path": path}})

    def place(self, node: int, place: Array, angle: Array) -> None:
        """Move a node to places (n, 3) (m), turned about z by angles (n,) (rad); without the clip it is where it
        begins.
        """
        self.add(node, "translation", place)
        turn = self.turn(node, angle)
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
