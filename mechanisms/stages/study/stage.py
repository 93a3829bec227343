"""The stage ``study``: a mechanism solved at every point of a grid of its Params: out/<name>/study/study.csv.

A mechanism.py may say what is measured, ``measure(solution)`` with numbers by name; else it is the peaks of driver
efforts, of joint forces and of the speeds of traced points, and the mechanism's extent. Masses are those of
mechanism.py, else estimates, as parts belong to one set of lengths.
"""

from __future__ import annotations

import os
import warnings
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import TYPE_CHECKING, Any

from mechanisms.stages.loading import loading
from mechanisms.stages.study.grid import grid_of
from shared.contract.quantity import counted
from shared.stage import console
from shared.stage.errors import UserError
from shared.stage.paths import Out, known_name

if TYPE_CHECKING:
    import pandas

    from mbsd import Mechanism

WORST = 3
"""Failed points that are named."""


def run(name: str, words: str) -> None:
    """Solve the mechanism at every point; the same call goes on where it was stopped.

    Raises UserError, also where every point failed; the table with their reasons is written before.
    """
    from mbsd import MechanismError, study

    name = known_name(name)
    module, p = loading.load(name, "mechanism"), loading.params(name)
    grid = grid_of(name, words, p)
    folder = Out(name).folder / "study"
    save = folder / "study.csv"
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with _client() as client:
            table = study(
                partial(_built, name, module, p),
                grid,
                partial(_measured, name, module, p),
                client,
                folder=folder / "kept",
                save=save,
            )
    except MechanismError as error:
        raise UserError(str(error)) from error
    for line in _summary(name, table, list(grid)):
        console.say("study", line)
    console.say("study", f"{name}: {save}: {counted(len(table), 'point')}")
    if len(table) and all(isinstance(reason, str) for reason in table["reason"]):
        failed = "its one point" if len(table) == 1 else f"all {len(table)} points"
        first = "" if len(table) == 1 else ", the first"
        raise UserError(f"{name}: {failed} failed{first} for: {_reason(name, table['reason'].iloc[0])}")


def _client() -> AbstractContextManager[Any]:
    """The scheduler that CLUSTER names, else this machine."""
    if not os.environ.get("CLUSTER"):
        return nullcontext()
    from shared.cluster.address import connected

    return connected()


def _built(name: str, module: Any, p: Any, **point: Any) -> Mechanism:
    import dataclasses

    from mechanisms.stages.solve.masses import give_masses

    m = module.build(dataclasses.replace(p, **point))
    give_masses(m, None)
    return m


def _measured(name: str, module: Any, p: Any, m: Mechanism) -> dict[str, float]:
    from mechanisms.stages.solve import solving

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        solution = solving.motion_of(name, module, m, p)
    own = getattr(module, "measure", None)
    return dict(own(solution)) if own else peaks(solution)


def peaks(solution: Any) -> dict[str, float]:
    """What is measured where mechanism.py does not say: peaks over the motion, by name and unit."""
    import numpy as np

    out: dict[str, float] = {}
    for name in solution.mechanism.drivers:
        driver = solution.driver(name)
        out[f"{name} effort [{'N m' if driver.angular else 'N'}]"] = float(np.abs(driver.effort).max())
    for name in solution.mechanism.joints:
        out[f"{name} force [N]"] = float(solution.joint(name).magnitude.max())
    for name in solution.mechanism.traces:
        point = solution.point(name)
        out[f"{name} speed [m/s]"] = float(np.hypot(point.vx, point.vy).max())
        for axis in ("x", "y"):
            out[f"{name} span {axis} [m]"] = float(np.ptp(getattr(point, axis)))
    return out


def _summary(name: str, table: pandas.DataFrame, varied: list[str]) -> list[str]:
    """Where each measure is least and largest, and why points failed."""
    rows: list[dict[str, Any]] = table.to_dict("records")
    good = [row for row in rows if not isinstance(row["reason"], str)]
    failed = [row for row in rows if isinstance(row["reason"], str)]
    lines = []
    for column in [column for column in table.columns if column not in (*varied, "reason")] if good else []:
        low, high = (choose(good, key=lambda row: row[column]) for choose in (min, max))
        ends = [f"{row[column]:.4g} ({_point(row, varied)})" for row in (low, high)]
        lines.append(f"{name}: {column}: {ends[0]} to {ends[1]}")
    lines += [f"{name}: not at {_point(row, varied)}: {_reason(name, row['reason'])}" for row in failed[:WORST]]
    if len(failed) > WORST:
        lines.append(f"{name}: and {len(failed) - WORST} more of {len(rows)} points failed; the table has the reasons")
    return lines


def _reason(name: str, reason: str) -> str:
    """Return why a point failed, without the name of the mechanism and of the class of a refusal."""
    return reason.removeprefix(f"{UserError.__name__}: ").removeprefix(f"{name}: ")


def _point(row: dict[str, Any], varied: list[str]) -> str:
    values = {field: row[field] for field in varied}
    return ", ".join(
        f"{field} {value:.6g}" if isinstance(value, float) else f"{field} {value}" for field, value in values.items()
    )
