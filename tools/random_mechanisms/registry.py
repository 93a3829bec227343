"""The example of every kind in the registries of the solver, and the mechanisms of the gallery."""

from __future__ import annotations

import math
import warnings

import numpy as np

from mbsd import Mechanism
from mbsd.kinematics.period import common_period
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import CONTACT_KINDS, KINDS
from mbsd.model.laws.examples import EXAMPLES
from mechanisms.stages.loading import loading
from mechanisms.stages.solve import solving
from shared.stage.paths import planar_names
from tools.random_mechanisms.subject import Builder, Subject, attempt, family

# The example of every kind in the solver's registries, so that a new kind is hunted without being named here.


CENTRES = {"gear_pair": 0.3, "belt": 0.7}
"""Distances (m) at which the examples meet."""


def two_bodies(name: str, rng: np.random.Generator) -> Mechanism:
    """Two bodies on soft mounts; what is between them moves them."""
    m = Mechanism(name, gravity=(float(rng.normal()), -9.81))
    for k, body in enumerate(("first", "second")):
        made = m.body(body, float(rng.uniform(0.5, 2)), list(rng.normal(scale=0.2, size=2)), float(rng.uniform(0.2, 1)))
        x, y = (float(value) for value in rng.normal(scale=0.4, size=2))
        m.bushing(f"mount {body}", m.ground.at(0.8 * k + x, y), made.origin, (40.0, 60.0, 3.0), (1.0, 1.5, 0.1))
        m.start_near(**{body: (0.8 * k + x, y, float(rng.uniform(-40, 40)))})
        m.start_moving(**{body: tuple(float(v) for v in rng.normal(scale=0.5, size=3))})
    return m


def markers(m: Mechanism, rng: np.random.Generator):
    """One on each body."""
    return [m.bodies[name].at(*(float(x) for x in rng.normal(scale=0.3, size=3))) for name in ("first", "second")]


def _joint_or_driver(name: str):
    def build(rng: np.random.Generator) -> Subject:
        m = two_bodies(name, rng)
        i, j = markers(m, rng)
        if name == "geneva":  # it asks for its own distance of centres
            arm = m.bar("arm", 0.3 / math.sin(math.pi / 5), 1.0)
            m.revolute("held", i, arm.start)
            m.revolute("holds", arm.end, j)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            KINDS[name].example(m, i, j)
        if name in CENTRES:
            m.distance("arm", i, j, length=CENTRES[name])
        if name == "rack_and_pinion":  # its pinion's radius over the pitch line
            c, s = math.cos(i.angle), math.sin(i.angle)
            m.pin_in_slot("held", i.body.at(i.x - 0.3 * s, i.y + 0.3 * c, i.angle), j)
        traits = {"jumps"} if name in ("geneva", "cam_roller", "cam_flat") else set()
        return Subject(m, float(rng.uniform(0.1, 0.4)), False, traits=frozenset(traits))

    return build


def _force(name: str):
    def build(rng: np.random.Generator) -> Subject:
        m = two_bodies(name, rng)
        example = FORCE_KINDS[name].example
        assert example is not None
        example(m, *markers(m, rng))
        traits = {"stiff"} if FORCE_KINDS[name].of_reactions else set()
        return Subject(m, float(rng.uniform(0.1, 0.4)), False, traits=frozenset(traits))

    return build


def _contact(name: str):
    def build(rng: np.random.Generator) -> Subject:
        m = two_bodies(name, rng)
        CONTACT_KINDS[name].example(m, *markers(m, rng))
        if attempt(lambda: m.simulate(1e-6, steps=1))[0] is None:  # it starts inside the other
            return build(rng)
        return Subject(m, float(rng.uniform(0.1, 0.4)), False, traits=frozenset({"contacts"}))

    return build


def _law(k: int):
    def build(rng: np.random.Generator) -> Subject:
        m = Mechanism("law")
        crank, bob = m.bar("crank", 0.3, 1.0), m.bar("bob", 0.4, 0.5)
        m.revolute("O", m.ground.origin, crank.start)
        m.revolute("A", crank.end, bob.start)
        m.drive_angle("motor", crank, EXAMPLES[k])
        m.start_near(bob=float(rng.uniform(-150, -30)))
        if rng.random() < 0.5:
            return Subject(m, 1.4, False)
        m.drive_relative_angle("second", crank, bob, EXAMPLES[int(rng.integers(len(EXAMPLES)))])
        return Subject(m, 1.4, True, 1.4)

    return build


for _name, _kind in KINDS.items():
    if _name not in CONTACT_KINDS:
        family(f"example of {'driver' if _kind.driven else 'joint'} {_name}", example=True)(_joint_or_driver(_name))
for _name in FORCE_KINDS:
    family(f"example of force {_name}", example=True)(_force(_name))
for _name in CONTACT_KINDS:
    family(f"example of contact {_name}", example=True)(_contact(_name))
for _k, _law_example in enumerate(EXAMPLES):
    family(f"example of law {_k} {type(_law_example).__name__}", example=True)(_law(_k))


# The mechanisms of the gallery, each over its own motion: what the project shows is hunted as well.


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


for _name in planar_names():
    family(f"gallery {_name}", WEIGHT)(_builder(_name))
