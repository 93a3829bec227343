"""Forces by functions, of mbsd and of the user, as arrays with the addresses that kernels call."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mbsd.compiling.callback import Callback
from mbsd.compiling.jit import COMPILED
from mbsd.spatial.arrays.tables import Tables
from mbsd.spatial.equations.bushing import bushing
from mbsd.spatial.equations.contact import contact, tyre
from mbsd.spatial.model.force import Force
from mbsd.spatial.model.rotation import euler_parameters

LAWS: dict[str, Any] = {"bushing": bushing, "contact": contact, "tyre": tyre}
"""Laws of mbsd by the names that forces give them."""


def addresses_of(name: str, forces: Sequence[Force]) -> tuple[list[int], list[Callback]]:
    """Return the address of the function of each force that has one, and what keeps them there."""
    addresses, callbacks = [], []
    for force in forces:
        call = force.call
        if call is None:
            continue
        frames, is_users = len(call.frames), callable(call.function)
        function = call.function if is_users else LAWS[call.function]
        if is_users or not COMPILED:
            parts = (7 * frames, 6 * frames) if is_users else (13 * frames + len(call.numbers),)
            own = function if is_users else filling(function, 6 * frames + 1)
            function = Callback(own, parts, 6 * frames + (not is_users), f"{name}: force '{force.name}'")
            callbacks.append(function)
        addresses.append(function.address)
    return addresses, callbacks


def calls_of(addresses: Sequence[int], forces: Sequence[Force], tables: Tables) -> dict[str, np.ndarray]:
    """Return the fields of a System for forces by functions at these addresses."""
    table, places, turns, inputs = [], list[int](), list[np.ndarray](), list[float]()
    calls = [call for force in forces if (call := force.call) is not None]
    for address, call in zip(addresses, calls, strict=True):
        table.append((address, len(places), len(call.frames), len(inputs)))
        places += [tables.place(marker) for marker in call.frames]
        turns += [euler_parameters(marker.body.principal[1].T @ marker.axes) for marker in call.frames]
        inputs += [*[0.0] * (13 * len(call.frames)), *call.numbers]
    return {
        "call": np.array(table, np.int64).reshape(-1, 4),
        "frame_place": np.array(places, np.int64),
        "frame_turn": np.array(turns).reshape(-1, 4),
        "inputs": np.array(inputs, float),
    }


def filling(function: Callable[..., None], count: int) -> Callable[[float, np.ndarray], np.ndarray]:
    """Return a function that returns what a law would fill in."""

    def returned(t: float, inputs: np.ndarray) -> np.ndarray:
        out = np.zeros(count)
        function(t, inputs, out)
        return out

    return returned
