"""Takes the mass of each body from mechanism.py, else from its parts, else from an estimate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from shared.contract.quantity import written
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.suggestions import did_you_mean

if TYPE_CHECKING:
    from mbsd import Mechanism
    from shared.contract import BodyParts, Parts

Source = Literal["mechanism", "parts", "estimate"]
LISTED = 8
"""At most so many masses are listed in a line."""
ALIKE = 1e-9
"""Masses of mechanism.py and of the parts that differ by less, relatively, are one."""


def give_masses(m: Mechanism, parts: Parts | None) -> tuple[dict[str, Source], list[str]]:
    """Give each body of ``m`` that has no mass that of its parts, or an estimate where there are no parts yet.

    A body whose mass or inertia mechanism.py gives keeps it; one that the parts leave out gets an estimate. Returns
    where each mass is from, and a sentence on each thing that a user may not expect. Raises UserError if parts and
    mechanism do not name the same bodies.
    """
    if parts is not None:
        _refuse_other_bodies(m, parts)
    given = [name for name, body in m.bodies.items() if body.mass_given or body.mass > 0 or body.inertia > 0]
    solids = bodies_of(parts) if parts is not None else {}
    source: dict[str, Source] = {}
    for name in m.bodies:
        if name != "ground":
            source[name] = "mechanism" if name in given else "parts" if name in solids else "estimate"
    sentences = _estimate(m, [name for name in source if source[name] == "estimate"], parts is not None)
    if parts is None:
        return source, sentences
    for name in source:
        if source[name] == "parts":
            mass = solids[name].mass
            m.set_mass(name, mass.mass, mass.com, mass.inertia, mass.z, mass.products)
    differing = [
        f"{name} {written(m.bodies[name].mass, 'kg', 4)} (parts {written(solids[name].mass.mass, 'kg', 4)})"
        for name in source
        if source[name] == "mechanism" and name in solids and _differ(m.bodies[name].mass, solids[name].mass.mass)
    ]
    if differing:
        sentences.append(f"masses of mechanism.py count, not those of the parts: {_some(differing)}")
    rods = [f"{name} {written(rod.mass.mass, 'kg', 4)}" for name, rod in parts.bodies.items() if name not in solids]
    if rods:
        sentences.append(f"rods have no mass in the motion, because distance joints have none: {_some(rods)}")
    return source, sentences


def leaves_masses(m: Mechanism) -> bool:
    """Return True if mechanism.py leaves the mass of a body to its parts; ``m`` then has estimates in their place."""
    return "estimate" in give_masses(m, None)[0].values()


def give_masses_aloud(stage: str, name: str, m: Mechanism, parts: Parts | None) -> None:
    """:func:`give_masses` of the mechanism ``name``; its sentences are said in the name of ``stage``."""
    sources, sentences = give_masses(m, parts)
    of_parts = [body for body, source in sources.items() if source == "parts"]
    if of_parts:
        sentences = [f"masses of the parts: {', '.join(of_parts)}", *sentences]
    for sentence in sentences:
        say(stage, f"{name}: {sentence}")


def bodies_of(parts: Parts) -> dict[str, BodyParts]:
    """The bodies of parts.json without its rods, which are none of mechanism.py."""
    return {name: body for name, body in parts.bodies.items() if body.spans is None}


def _estimate(m: Mechanism, names: list[str], left_out: bool) -> list[str]:
    """Give these bodies the mass of plates; the sentence that says so."""
    if not names:
        return []
    from mechanisms.stages.solve.estimated_masses import estimated_masses

    estimates = estimated_masses(m)
    for name in names:
        m.set_mass(name, estimates[name].mass, estimates[name].com, estimates[name].inertia)
    masses = _some([f"{name} {written(estimates[name].mass, 'kg')}" for name in names])
    why = "bodies without solids" if left_out else "no parts yet, so masses"
    return [f"{why} are estimated as aluminium bars and plates through the markers: {masses}"]


def _some(masses: list[str]) -> str:
    """The first of them, and how many others there are."""
    more = len(masses) - LISTED
    return ", ".join(masses) if more <= 1 else f"{', '.join(masses[:LISTED])} and {more} others"


def _differ(first: float, second: float) -> bool:
    return abs(first - second) > ALIKE * max(first, second)


def _refuse_other_bodies(m: Mechanism, parts: Parts) -> None:
    bodies = set(m.bodies) - {"ground"}
    solids = {*bodies_of(parts), *parts.without_solids} - {"ground"}
    for missing, where, there in ((bodies - solids, "parts.py", solids), (solids - bodies, "mechanism.py", bodies)):
        if missing:
            raise UserError(
                f"{m.name}: {where} has no body '{min(missing)}'; it has: {', '.join(sorted(there)) or 'none'}"
                f"{did_you_mean(min(missing), there) or '.'} mechanism.py and parts.py must name the same bodies "
                "(Bodies.leave_out names one without solids)"
            )
