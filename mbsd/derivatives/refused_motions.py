"""Motions that have no derivatives here, and numbers that cannot change by themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import marker_places
from mbsd.base.errors import ModelError
from mbsd.derivatives.numbers.terms import Along, Terms
from mbsd.derivatives.numbers.variants import Variant, Variants
from mbsd.dynamics.prepare.inertia import USUAL
from mbsd.dynamics.repeated import Course
from mbsd.equations.relative.equation import AT, WRAPS

KEPT = 1e-4
"""Part of the sizes of the mechanism and of a number by which this may move what must stay: rounding is less."""


def refuse_parted(terms: Terms, along: Along, variants: Variants, q: np.ndarray) -> None:
    """Raise ModelError for a number that takes wheels apart which must mesh; q (T, 3 nb): how places change with it."""
    first = terms.packed
    for k, (constraint, joint) in enumerate(zip(first.specials.names, first.specials.joints, strict=True)):
        if joint.kind.kept is None:
            continue
        wraps = constraint == "gear" and first.system.numbers[int(first.system.special[k, AT]) + WRAPS] != 0.0
        rows = slice(0, 1 if wraps else None)  # of gears whose centres nothing holds apart, the start
        slope = np.zeros(len(along.t[rows]))
        for weight, variant in zip(variants.weights, variants.variants, strict=True):
            there = along.q[rows] + variant.offset * variants.step * q[rows]
            slope += weight / variants.step * _kept_length(variant.terms.packed, k, there)
        if np.abs(slope).max(initial=0.0) * variants.size > KEPT * first.size:
            raise ModelError(
                f"{first.name}: no derivative by '{variants.number.name}': by itself it takes {joint.kind.name} "
                f"'{joint.name}' out of mesh, for the places of its two sides and their radii go together. Ask for a "
                "number that moves all of them, as an argument of a function that builds the mechanism: "
                "optimise(..., build=)"
            )


def refuse_opened(along: Along, variants: Variants, q: np.ndarray, closed: list[int]) -> None:
    """Raise ModelError for a number that opens rows which are ``closed``; q (T, 3 nb): how places change with it."""

    def residuals(variant: Variant) -> np.ndarray:
        packed = variant.terms.packed
        moved = replace(along, q=along.q + variant.offset * variants.step * q)
        return (variant.terms.rows(moved)[0] * packed.row_scale())[:, closed]

    if np.abs(variants.slope(residuals)).max(initial=0.0) * variants.size > KEPT:
        name = variants.variants[0].terms.packed.name
        raise ModelError(fits_alone(name, variants.number.name))


def fits_alone(mechanism: str, number: str) -> str:
    """Return the words of an error for a number at another value of which joints that repeat others open."""
    return (
        f"{mechanism}: no derivative by '{number}': joints repeat others, and fit at this value of it alone. Change "
        "several numbers together by build=, or free a joint"
    )


def _kept_length(packed: Packed, k: int, q: np.ndarray) -> np.ndarray:
    """(T,) length (m) that special constraint k needs, in poses q (T, 3 nb)."""
    joint, (i, j, *_) = packed.specials.joints[k], packed.specials.places[k]
    assert joint.kind.kept is not None
    dx, dy = (marker_places(packed, q, j) - marker_places(packed, q, i)).T
    turn = q[:, 3 * packed.system.marker_body[i] + 2] + joint.i.angle
    return joint.kind.kept(joint.params, np.cos(turn) * dx + np.sin(turn) * dy, np.cos(turn) * dy - np.sin(turn) * dx)


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
            f"{packed.name}: derivatives of simulations where inertias of joined bodies are more than {USUAL:.0e} "
            "times apart are not known: differences of forces lose what the light bodies feel. Give light bodies the "
            "mass and inertia 0, hold the heavy one by ground, or ask for the motion alone"
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
        if force.kind.of_spans:
            raise ModelError(
                f"{packed.name}: derivatives with friction of cables on wheels ('{force.name}') are not known"
            )
        if force.params.get("sticks"):
            raise ModelError(
                f"{packed.name}: derivatives where joints stick ('{force.name}') are not known; give a slip_speed"
            )
