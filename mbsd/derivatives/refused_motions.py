"""Motions that have no derivatives here."""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.dynamics.prepare.mass_ratio import USUAL
from mbsd.dynamics.repeated import Course


def refuse(first: Course) -> None:
    """Raise ModelError for what a simulation holds that has no derivatives here."""
    packed = first.packed
    names = [force.name for force in packed.forces if force.kind.states is not None]
    if names:
        raise ModelError(
            f"{packed.name}: derivatives of simulations with states of forces ('{names[0]}') are not known"
        )
    if first.masses_apart:
        raise ModelError(
            f"{packed.name}: derivatives of simulations where inertias of joined bodies are more than {USUAL:.0e} times "
            "apart are not known: differences of forces lose what the light bodies feel. Give light bodies the mass "
            "and inertia 0, hold the heavy one by ground, or ask for the motion alone"
        )
    if first.remembers:
        raise ModelError(
            f"{packed.name}: derivatives where the damping of a contact remembers how fast it approached are not "
            "known; give damping= instead of restitution="
        )
    for force in packed.forces:
        if "cycle" in {*force.params, *force.laws}:
            raise ModelError(
                f"{packed.name}: derivatives of simulations with the cycle of a gas ('{force.name}'), whose pressure "
                "jumps on the way, are not known; those of a sweep are"
            )
        if force.params.get("sticks"):
            raise ModelError(
                f"{packed.name}: derivatives where joints stick ('{force.name}') are not known; give a slip_speed"
            )
