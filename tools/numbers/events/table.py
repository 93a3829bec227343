"""All runs by name: the models as they are, in both formulations, and by every integrator."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator

import mbsd.dynamics.integrators
from mbsd.dynamics.integrators.kind import INTEGRATORS, Integrator
from tools.numbers.events import contacts, dry, ends, guided, larger, refused, users
from tools.numbers.events.record import Case

TABLES = (contacts, ends, dry, guided, users, larger, refused)
SMOOTH = (
    "ball 0.5 from 1",
    "cradle of 3, elastic",
    "pendulum at a stop 0.5",
    "joints with limits",
    "rope 0.5",
    "clutch that holds and overruns",
    "stop that holds at a jump",
    "swing",
    "geneva with a stop",
)
"""Runs by every integrator."""
ROUGH = (
    "disc that slides and rolls 0.25",
    "block on a belt 0.6",
    "block on an incline of 0.2",
    "lever and ball",
    "slider-crank comes to rest",
)
"""Runs by every integrator that knows friction."""
UNFIT = {
    ("block on a belt 0.6", "scipy-lsoda"),
    ("stop that holds at a jump", "scipy-lsoda"),
    ("clutch that holds and overruns", "scipy-lsoda"),
    ("rope 0.5", "scipy-lsoda"),
    ("clutch that holds and overruns", "rattle"),
}
"""Runs that are not recorded: LSODA's choices move them by 2e-8 and more; RATTLE stops where the clutch opens."""
STEP = 2.5e-3
"""s, of methods with steps of one length."""
WITHOUT_FRICTION = ("rattle", "symplectic")


def cases() -> list[Case]:
    """Return all of them. Raises ValueError where two have one name."""
    own = [case for table in TABLES for case in table.cases()]
    own += [by for case in own for by in (*_formulations(case), *_methods(case))]
    names = [case.name for case in own]
    if len(set(names)) < len(names):
        raise ValueError(f"runs have one name: {sorted({name for name in names if names.count(name) > 1})}")
    return own


def _formulations(case: Case) -> Iterator[Case]:
    """The same run where the formulation is said."""
    if not case.refused and "formulation" not in case.options:
        yield case.by("reference", formulation="reference")


def _methods(case: Case) -> Iterator[Case]:
    for method in sorted(METHODS):
        if (case.name, method) in UNFIT:
            continue
        if case.name in SMOOTH or (case.name in ROUGH and method not in WITHOUT_FRICTION):
            step = {"step": STEP} if METHODS[method].fixed_step else {}
            yield case.by(method, method=method, **step)


def _installed() -> dict[str, Integrator]:
    for module in pkgutil.iter_modules(mbsd.dynamics.integrators.__path__):
        importlib.import_module(f"mbsd.dynamics.integrators.{module.name}")
    return {name: own for name, own in INTEGRATORS.items() if name != "dop853" and own.installed}


METHODS = _installed()
"""Integrators beside the usual one."""
