"""All results of a solution as columns named with their units, for tables and files."""

from __future__ import annotations

from typing import Any

import numpy as np

FRAME = {
    "x": "m",
    "y": "m",
    "theta": "rad",
    "vx": "m/s",
    "vy": "m/s",
    "omega": "rad/s",
    "ax": "m/s^2",
    "ay": "m/s^2",
    "alpha": "rad/s^2",
}
JOINT = {"x": "m", "y": "m", "fx": "N", "fy": "N", "torque": "N m"}
DRIVER = ("value", "effort", "power")


def columns(sol: Any) -> dict[str, np.ndarray]:
    """See :meth:`mbsd.results.solution.Solution.columns`; ``sol`` is that Solution."""
    m, bodies, traced = sol.mechanism, set(sol.packed.body_names), set(sol.mechanism.traces)
    forces = [force.name for force in sol.packed.forces]
    joined = {*m.joints, *m.drivers, *forces}
    out: dict[str, np.ndarray] = {}

    def title(what: str, name: str, taken: set[str]) -> str:
        return f"{what} {name}" if name in taken else name

    for name in sol.packed.body_names[1:]:
        view = sol.body(name)
        out |= {f"{name}.{key} [{unit}]": getattr(view, key) for key, unit in FRAME.items()}
    for name in m.traces:
        view, whole = sol.point(name), title("trace", name, bodies | joined)
        out |= {f"{whole}.{key} [{unit}]": getattr(view, key) for key, unit in FRAME.items() if "rad" not in unit}
    for name in m.joints:
        view, whole = sol.joint(name), title("joint", name, bodies | traced)
        out |= {f"{whole}.{key} [{unit}]": getattr(view, key) for key, unit in JOINT.items()}
    for name, driver in m.drivers.items():
        view, whole = sol.driver(name), title("driver", name, bodies | traced)
        effort, value = driver.kind.units
        out |= {f"{whole}.value [{value}]": view.value, f"{whole}.effort [{effort}]": view.effort}
        out[f"{whole}.power [W]"] = view.power
    for name in forces:
        out |= sol.force(name).columns(title("force", name, bodies | traced))
    return out | {"kinetic [J]": sol.energy.kinetic, "potential [J]": sol.energy.potential}
