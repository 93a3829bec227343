"""Results that must agree to the last bit: a changed model and a fresh one, a pickled solution."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd import Mechanism
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import pack
from mbsd.base.errors import ModelError
from mbsd.model.change import arguments, given, given_body
from mbsd.results.solution import Solution
from mbsd.saving.document import build, document
from tools.hunt.outcome import AGREED, UNCLEAR, WRONG, Outcome
from tools.random_mechanisms.subject import attempt

# A number of a mechanism changed and changed back, with a solution between.


def there_and_back(m: Mechanism, rng: np.random.Generator, solve: Callable[[], Any]) -> bool:
    """Change a random number by up to a half, solve whatever comes of it, and change it back.

    Returns False if there is none.
    """
    changes: list[tuple[str, str, float]] = []
    for name, body in m.bodies.items():
        if name != "ground" and body.mass > 0:
            changes += [(name, "mass", body.mass), (name, "inertia", body.inertia)]
    for table in (m.joints, m.drivers, m.forces, m.contacts):
        for name, entry in table.items():
            changes += [
                (name, key, value)
                for key, value in entry.params.items()
                if isinstance(value, float) and value > 0 and key != "direction"
            ]
    if not changes:
        return False
    name, key, value = changes[int(rng.integers(len(changes)))]
    _, error = attempt(lambda: m.change(name, **{key: value * float(rng.uniform(0.6, 1.4))}))
    if error is None:
        attempt(solve)
        m.change(name, **{key: value})
    return True


OPTIONAL = {"static", "static_friction", "slip_speed"}
"""Arguments that follow from others where they are left out."""
TABLES = ("joints", "drivers", "forces", "contacts")


def changed(name: str, m: Mechanism, rng: np.random.Generator) -> Outcome:
    """Return the outcome of a model changed to the numbers of ``m``, which must be that model."""
    differs = changed_differs(m, rng)
    if differs is None:
        return Outcome(name, UNCLEAR, "nothing to change, or no file could hold it")
    return Outcome(name, WRONG, "differs", differs) if differs else Outcome(name, AGREED)


def pickled(name: str, sol: Solution | None) -> Outcome:
    """Return the outcome of pickling a solution, if there is one, which must come back as it was."""
    if sol is None:
        return Outcome(name, UNCLEAR, "refused as built")
    differs = pickled_differs(sol)
    return Outcome(name, WRONG, "differs", differs) if differs else Outcome(name, AGREED)


def changed_differs(m: Mechanism, rng: np.random.Generator) -> str | None:
    """Return how a model changed to the numbers of ``m`` differs from one built so; "" if it does not.

    Numbers that may follow from others are left out now and then. None where there is nothing to change, or no file
    could hold the model.
    """
    try:
        wanted = document(m)
        for entry in (entry for table in TABLES for entry in wanted[table].values()):
            for key in OPTIONAL & entry["params"].keys():
                if rng.random() < 0.5:
                    del entry["params"][key]
        for body in wanted["bodies"].values():
            if body["length"] is not None and rng.random() < 0.5:
                body["inertia"] = None
        fresh = build(wanted, Mechanism)
    except ModelError:
        return None
    places = [(table, name) for table in TABLES for name in wanted[table]] + [("bodies", n) for n in wanted["bodies"]]
    done = []
    other = fresh
    for k in rng.permutation(len(places))[:4]:
        table, name = places[int(k)]
        at_first = copy.deepcopy(document(other))
        values = _altered(at_first[table][name], table, rng)
        try:
            other = build(at_first, Mechanism)
        except ModelError:
            continue  # these numbers cannot be
        if values:
            own = _own(fresh, table, name)
            other.change(name, **{key: own[key] for key in values})
            done.append(f"{name}: {', '.join(values)}")
    if not done:
        return None
    return "" if bits(other) == bits(fresh) else f"after changes of {'; '.join(done)}"


def _own(m: Mechanism, table: str, name: str) -> dict[str, Any]:
    """Arguments with which it was added, None for those left out."""
    if table == "bodies":
        return dict.fromkeys(("com", "inertia")) | given_body(m.bodies[name])
    entry = getattr(m, table)[name]
    return {parameter.name: None for parameter in arguments(entry.kind.add)} | given(entry)


def _altered(entry: dict[str, Any], table: str, rng: np.random.Generator) -> list[str]:
    """Make some numbers of an entry of a document others; the arguments that were altered."""
    numbers = entry if table == "bodies" else entry["params"]
    lengths = [key for key, value in numbers.items() if isinstance(value, float) and value > 0 and key != "length"]
    chosen = [key for key in lengths if rng.random() < 0.6]
    for key in chosen:
        numbers[key] *= float(rng.uniform(0.6, 1.4))
    law = entry.get("law")
    if isinstance(law, dict) and isinstance(law.get("rate"), float):
        law["rate"] *= 1.5
        chosen.append("law")
    return chosen


def bits(m: Mechanism) -> tuple[Any, ...]:
    """Return all that the solver and a file get of a model."""
    packed = pack(m, list(m.contacts.values()))
    loads = [part.tobytes() for part in pack_loads(packed) if isinstance(part, np.ndarray)]
    return document(m), [np.asarray(array).tobytes() for array in packed.system], loads


def renamed_differs(first: Solution, other: Solution) -> str:
    """Return how a solution of the same mechanism with other names differs; "" if it does not."""
    parts = ("t", "q", "v", "a", "wrench", "lam", "drives", "singularity_margin")
    return next(
        (key for key in parts if not np.array_equal(getattr(first, key), getattr(other, key), equal_nan=True)), ""
    )


def pickled_differs(sol: Solution) -> str:
    """The first quantity that a solution has otherwise after pickling; "" if there is none."""
    other: Solution = pickle.loads(pickle.dumps(sol))
    mine, its = sol.columns(), other.columns()
    mine["margin"], its["margin"] = sol.singularity_margin, other.singularity_margin
    if sol.work is not None and len(sol.t) > 2:
        middle = [float(sol.t[0] + 0.37 * (sol.t[-1] - sol.t[0]))]
        mine["between"], its["between"] = sol.at(middle).q, other.at(middle).q
    if mine.keys() != its.keys():
        return f"other columns: {sorted(mine.keys() ^ its.keys())[:3]}"
    return next((key for key in mine if not np.array_equal(mine[key], its[key], equal_nan=True)), "")
