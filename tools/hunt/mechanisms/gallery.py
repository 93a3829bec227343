"""The mechanisms of the gallery, each over its own motion: what the project shows is hunted as well."""

from __future__ import annotations

import warnings

import numpy as np

from mbsd import Mechanism
from mbsd.kinematics.period import common_period
from mechanisms.stages.loading import loading
from mechanisms.stages.solve import solving
from shared.stage.paths import mechanism_names
from tools.hunt.subject import Builder, Subject, family

WEIGHT = 0.1
"""Weight of each mechanism: all of them together count as four other kinds."""
LONGEST, SHORTEST = 1.0, 0.05
"""s of a simulation, drawn from the first part of its own."""
BESIDE = 0.9871
"""Part of a motion whose accelerations jump at simple fractions of it: at a jump itself either side is right."""
STIFF = {"tyre", "hydraulic_cylinder", "gas_strut", "contact", "gear_mesh"}
JUMPS = {"geneva", "cam_roller", "cam_flat"}


def loaded(name: str) -> tuple[Mechanism, float | None]:
    """A mechanism of the gallery by its folder, and how long its motion is said to be (s)."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        module, p = loading.load(name, "mechanism"), loading.params(name)
        duration = loading.constant(name, module, "DURATION")
        return solving.build(name, module, p), None if duration is None else float(duration)


def subject_of(name: str, rng: np.random.Generator) -> Subject:
    """One of them as a subject: a sweep over its period, or the first part of its simulation."""
    m, duration = loaded(name)
    for body in m.bodies.values():
        if body.name != "ground" and body.mass == 0.0 and not body.mass_given:
            m.set_mass(body.name, 0.1, body.com, 1e-4)  # else that of its parts
    kinds = {entry.kind.name for table in (m.joints, m.forces, m.contacts) for entry in table.values()}
    traits = {trait for trait, own in (("stiff", STIFF), ("jumps", JUMPS)) if kinds & own}
    traits |= {"contacts"} if m.contacts or m.events else set()
    if m.mobility().dof <= len(m.drivers):
        turn = common_period(m.drivers.values())
        whole = duration or m.period() or turn or 1.0
        span = min(whole, 2.0 * (turn or whole)) * (BESIDE if "jumps" in traits else 1.0)
        return Subject(m, span, True, turn, traits=frozenset(traits))
    span = min(duration or LONGEST, LONGEST)
    return Subject(m, float(rng.uniform(SHORTEST, 1.0)) * span, False, traits=frozenset(traits))


def _builder(name: str) -> Builder:
    return lambda rng: subject_of(name, rng)


for _name in mechanism_names():
    family(f"gallery {_name}", WEIGHT)(_builder(_name))
