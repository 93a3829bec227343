"""Equations of motion for programs without Python: machine code, memory, and the calls.

In reference coordinates, so that any mechanism goes; what Python itself decides between steps does not: events, limits,
impacts and joints that stick. Contacts by penalty are in the compiled loop.

    advance       goes on to a time by DOP853, with every step projected onto the constraints
    derivative    rates of coordinates and speeds, and multipliers, at a state
    project       a state onto its constraints
    jacobian      rows of J at a pose, for reactions
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numba import typeof

from mbsd.base.errors import ModelError
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.integrators.dop853 import DOP853
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.projection import project
from mbsd.dynamics.runs.run import REFERENCE, Run
from mbsd.dynamics.state import State, output_for
from mbsd.equations.assembly import tabulate_all
from mbsd.equations.interactions.switching import SWITCHING
from mbsd.model.mechanism import Model
from mbsd.native.machine_code import MachineCode, functions_at
from mbsd.native.memory import WORD, Memory, leaves, memory_of, number

MANY_STEPS = 10**9


@dataclass(frozen=True)
class Word:
    """One word of an entry's table: a number, or a place in the memory (bytes from its start)."""

    value: int
    place: bool


class NativeEquations:
    """The equations of one mechanism from a time on.

    Raises ModelError for a model that cannot go without Python, by the name of what it is.
    """

    def __init__(self, m: Model, start: float, end: float, tolerance: float) -> None:
        """Prepare the equations; laws are looked at from ``start`` to ``end`` (s).

        ``tolerance`` is that of simulate.
        """
        _refuse(m)
        self.model = m
        self.ready: PreparedDynamics = prepare_dynamics(m, start, end, contacts=True)
        _check_prepared(self.ready)
        self.tolerance = tolerance
        self.run = Run(self.ready, DOP853, tolerance, end - start, end - start, {}, REFERENCE)
        self.state: State = self.ready.begun(np.array([start]))[0]
        dynamics, scratch = self.ready.dynamics, self.run.scratch
        derivative(dynamics, scratch, start, self.state.y, self.state.dy, self.state.lam)
        self.ready.packed.specials.check()
        self.jacobian_at = np.zeros((1, len(self.state.lam), 6))
        self.no_rows = np.zeros((1, len(self.state.lam)))
        y, ws = self.state.y, scratch.ws
        nowhere = output_for(np.zeros(0), y.shape[1], len(self.state.lam))
        self.arguments: dict[str, tuple[Any, tuple[Any, ...]]] = {
            "advance": (
                DOP853.advance, (dynamics, scratch, self.state, nowhere, self.run.settings, end, MANY_STEPS)
            ),
            "derivative": (derivative, (dynamics, scratch, start, y, self.state.dy, self.state.lam)),
            "project": (project, (dynamics, scratch, start, y, 2)),
            "jacobian": (
                tabulate_all,
                (
                    dynamics.system, scratch.drive[None], y[None, 0], y[None, 1], ws, self.no_rows, self.jacobian_at,
                    self.no_rows.copy(),
                ),
            ),
        }  # fmt: skip
        self.stops = self.ready.stops

    @property
    def switches(self) -> bool:
        """True if contacts by penalty begin and end."""
        return bool(self.ready.dynamics.loads.switch[0, SWITCHING])

    @property
    def exchange(self) -> bool:
        """True if rates follow from the state alone.

        Damping by restitution also needs the speed of the approach.
        """
        return not self.ready.approaches

    @property
    def left_out(self) -> list[str]:
        """Names of what programs without Python do not get."""
        out = []
        if self.ready.mobility.redundant_rows:
            out.append("reactions of redundant joints as they are shared least: one set of joints carries all")
        if not self.exchange:
            out.append(
                "model exchange: the damping of contacts depends on how fast they approached; co-simulation is in it"
            )
        return out

    @cached_property
    def memory(self) -> Memory:
        """All arrays of all arguments, as they stand at the start; zeros for the addresses of this process."""
        arguments = [values for _, values in self.arguments.values()]
        made = memory_of(leaf for _, leaf in leaves(tuple(arguments)) if isinstance(leaf, np.ndarray))
        content = bytearray(made.content)
        for array, entry, _, _ in functions_at(self.ready.packed, self.ready.dynamics.loads):
            place = made.offset(array, *entry)
            content[place : place + WORD] = bytes(WORD)
        return replace(made, content=bytes(content))

    def table(self, entry: str) -> dict[str, list[Word]]:
        """The words of an entry's table, by the path of each argument's leaf: 0.system.mass, ... ."""
        return {path: self._words(leaf) for path, leaf in leaves(self.arguments[entry][1])}

    def _words(self, leaf: Any) -> list[Word]:
        if isinstance(leaf, np.ndarray):
            return [Word(self.memory.offset(leaf), True), *(Word(n, False) for n in (*leaf.shape, *leaf.strides))]
        return [Word(number(leaf), False)]

    def functions(self) -> list[tuple[int, str]]:
        """Places in the memory that hold the address of a function, and its name."""
        return [
            (self.memory.offset(array, *entry), f"mbsd_{name}")
            for array, entry, name, _ in functions_at(self.ready.packed, self.ready.dynamics.loads)
        ]

    def assembly(self, triple: str | None = None) -> str:
        """Machine code of all entries, ``mbsd_advance`` and so on, in the assembler's language of a platform."""
        code = MachineCode()
        for name, (function, arguments) in self.arguments.items():
            code.add_entry(f"mbsd_{name}", function, [typeof(argument) for argument in arguments])
        packed, loads = self.ready.packed, self.ready.dynamics.loads
        for name, function in {name: made for _, _, name, made in functions_at(packed, loads)}.items():
            code.add_address(f"mbsd_{name}", function)
        return code.assembly(triple)


def _refuse(m: Model) -> None:
    """Raise ModelError for what Python decides between steps."""
    if m.events:
        name = next(iter(m.events))
        raise ModelError(
            f"{m.name}: event '{name}' is a function of Python, which the machine code does not contain; leave it out"
        )


def _check_prepared(ready: PreparedDynamics) -> None:
    packed = ready.packed
    for name in [*(contact.name for contact in ready.switches.contacts), *(stick.name for stick in ready.sticks)]:
        raise ModelError(
            f"{packed.name}: '{name}' opens, closes or sticks between steps, which Python decides; take a contact by "
            "penalty (m.contact) or friction with a slip speed instead"
        )
    for callback in packed.specials.callbacks:
        raise ModelError(
            f"{callback.what} is a function of Python, which the machine code does not contain; give a table or a "
            "curve instead"
        )
    if ready.following:
        raise ModelError(
            f"{packed.name}: a point on a curve that crosses itself, or wheels that may meet, are followed by Python "
            "step by step; the machine code cannot"
        )
