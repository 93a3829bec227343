"""The stage study: a mechanism at every point of a grid of its Params, as a table: study.csv."""

from __future__ import annotations

import dataclasses
import math
import os
import warnings
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import TYPE_CHECKING, Any

from mechanisms.stages.loading import loading
from shared.contract.quantity import counted
from shared.stage import console
from shared.stage.errors import UserError, did_you_mean
from shared.stage.paths import Out, known_name

if TYPE_CHECKING:
    import pandas

    from mbsd import Mechanism


# The grid of a study in words: ``crank=0.03:0.05:5; speed=6.28,12.6``: five values from 0.03 to 0.05, and two.

FORM = "name=from:to:count or name=value,value, with ';' between names, as in crank=0.03:0.05:5; speed=6,12"


def grid_of(name: str, words: str, p: Any) -> dict[str, list[Any]]:
    """Return values of fields of ``p`` (a Params) by name.

    Raises UserError for what is no grid, and for unknown fields.
    """
    fields = [field.name for field in dataclasses.fields(p) if field.init]
    grid: dict[str, list[Any]] = {}
    for part in filter(None, (part.strip() for part in words.split(";"))):
        field, equals, said = (piece.strip() for piece in part.partition("="))
        if not equals or not said:
            raise UserError(f"{name}: {part!r} is no part of a grid; write {FORM}")
        if field not in fields:
            raise UserError(
                f"{name}: its Params have no '{field}'; they have: {', '.join(fields)}{did_you_mean(field, fields)}"
            )
        if field in grid:
            raise UserError(f"{name}: the grid has '{field}' twice")
        grid[field] = _values(name, field, said, getattr(p, field), math.prod(map(len, grid.values())))
    if not grid:
        raise UserError(f"{name}: name the fields to vary: {FORM}")
    return grid


def _values(name: str, field: str, said: str, usual: Any, others: int) -> list[Any]:
    """Return values of one field; ``others``: how many points those before it make."""
    if ":" in said:
        first, last, count = _range(name, field, said)
        refuse_too_many(name, others * count)
        step = (last - first) / (count - 1)
        return [first + step * k for k in range(count - 1)] + [last]
    return [_value(name, field, word.strip(), usual) for word in said.split(",")]


def refuse_too_many(name: str, count: int) -> None:
    """Raise UserError for more points than a study may have, before they are listed."""
    from mbsd.studies.points import MOST

    if count > MOST:
        raise UserError(f"{name}: a grid of {count} points; take {MOST} at most, in several studies")


def _range(name: str, field: str, said: str) -> tuple[float, float, int]:
    try:
        first, last, count = said.split(":")
        numbers = float(first), float(last), int(count)
    except ValueError as error:
        raise UserError(
            f"{name}: {field}={said} is no range; write {field}=from:to:count, as in 0.03:0.05:5"
        ) from error
    if not (math.isfinite(numbers[0]) and math.isfinite(numbers[1]) and numbers[2] >= 2):
        raise UserError(f"{name}: {field}={said} needs two finite ends and two values or more")
    return numbers


def _value(name: str, field: str, word: str, usual: Any) -> Any:
    """Return a value of the kind that the field has."""
    if isinstance(usual, bool):
        if word.lower() in ("true", "false"):
            return word.lower() == "true"
        raise UserError(f"{name}: {field}={word} must be true or false")
    if isinstance(usual, str):
        return word
    if isinstance(usual, int | float):
        try:
            number = int(word) if isinstance(usual, int) else float(word)
        except ValueError as error:
            raise UserError(f"{name}: {field}={word} must be a {'whole ' * isinstance(usual, int)}number") from error
        if math.isfinite(number):
            return number
        raise UserError(f"{name}: {field}={word} must be finite")
    raise UserError(
        f"{name}: {field} is {type(usual).__name__}; a grid on the command line varies numbers, words and bools"
    )


# The stage ``study``: a mechanism solved at every point of a grid of its Params: out/<name>/study/study.csv.
#
# A mechanism.py may say what is measured, ``measure(solution)`` with numbers by name; else it is the peaks of driver
# efforts, of joint forces and of the speeds of traced points, and the mechanism's extent. Masses are those of
# mechanism.py, else estimates, as parts belong to one set of lengths.

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
    """Return the scheduler that CLUSTER names, else this machine."""
    if not os.environ.get("CLUSTER"):
        return nullcontext()
    from shared.cluster.address import connected

    return connected()


def _built(name: str, module: Any, p: Any, **point: Any) -> Mechanism:
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
    """Return the peaks over the motion, by name and unit: the measures of a mechanism.py that names none."""
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
    """Return where each measure is least and largest, and why points failed."""
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
