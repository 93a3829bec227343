"""The plates of a film: frames of one camera that stands, what moves before it, and the frame that tries the plate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import msgspec

from render.blender.job import Plate
from render.film.scene import State
from render.frames.keys import hash_of, rounded

SHORTEST = 16
"""Frames of one camera, at least: a plate takes as long as some five of them."""


@dataclass(frozen=True)
class Plates:
    """The plates of a film, and the index of its plate by frame. The state of a plate is the frame that tries it."""

    plates: list[Plate] = field(default_factory=list)
    of_frame: dict[int, int] = field(default_factory=dict)


def plates_of(shutters: Mapping[int, Sequence[State]], scene: str) -> Plates:
    """Return the plates of frames with these states, of which each frame's shutter sees one or more.

    ``scene`` is the key of what all frames have in common. A frame whose camera moves while the shutter is open has no
    plate.
    """
    cameras: dict[str, list[int]] = {}
    for frame, states in shutters.items():
        seen = {_key_of([state.camera, state.hidden]) for state in states}
        if len(seen) == 1:
            cameras.setdefault(seen.pop(), []).append(frame)
    plates, of_frame = [], {}
    for frames in cameras.values():
        if len(frames) >= SHORTEST:
            of_frame.update(dict.fromkeys(frames, len(plates)))
            plates.append(_plate({frame: shutters[frame] for frame in frames}, scene))
    return Plates(plates, of_frame)


def _plate(shutters: Mapping[int, Sequence[State]], scene: str) -> Plate:
    """Return the plate of frames with one camera. Its key is what stands; what moves, and how, does not matter."""
    states = [state for shutter in shutters.values() for state in shutter]
    first = states[0]
    lifts = sorted({name for state in states for name in state.lifts})
    bodies = _split({name: [state.bodies[name] for state in states] for name in first.bodies})
    pieces = _split({name: [state.lifts.get(name, 0.0) for state in states] for name in lifts})
    kinds = ("trails", "tubes", "labels")
    things = [
        _split({k: [getattr(state, kind)[k] for state in states] for k in range(len(getattr(first, kind)))})
        for kind in kinds
    ]
    standing = [bodies[0], pieces[0], *(stand for stand, _ in things)]
    moving = sorted([*bodies[1], *pieces[1]])
    key = _key_of([scene, first.camera, first.hidden, [sorted(stand.items()) for stand in standing], moving])
    tried = min(shutters, key=lambda frame: _key_of(list(shutters[frame])))
    return Plate(
        key=key[:32],
        trial=_key_of([key, list(shutters[tried])])[:32],
        state=tried,
        moving=moving,
        trails=things[0][1],
        tubes=things[1][1],
        labels=things[2][1],
    )


def _split(values: Mapping[Any, Sequence[Any]]) -> tuple[dict[Any, Any], list[Any]]:
    """Return what stands, by name, and the names of what changes; see :data:`render.frames.keys.DIGITS`."""
    plain = {name: [rounded(value) for value in row] for name, row in values.items()}
    standing = {name: row[0] for name, row in plain.items() if all(value == row[0] for value in row)}
    return standing, [name for name in plain if name not in standing]


def _key_of(value: Any) -> str:
    return hash_of(rounded(msgspec.to_builtins(value)))
