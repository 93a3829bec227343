"""Fit of the lengths of Params so that a traced point follows a drawn path."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from mbsd import Mechanism, MechanismError, fit_path
from shared.stage.errors import UserError
from studio.live.child.author import Author
from studio.live.child.dragging import lengths
from studio.live.numbers import in_digits, numbers_of

PERIOD = 0.1
"""Seconds between two words on how far it is; the last word always comes."""


def fitted(author: Author, request: dict[str, Any], reply: Callable[..., None]) -> None:
    """Fit, and send progress and result to ``reply``. Raises UserError.

    ``request``: point, path ([[x, y], ...] in m), closed, ordered, vary ({name: [low, high]}, or null for all lengths
    within the ranges of their sliders), starts, generations, seed, grashof, least_transmission (rad); values are where
    it begins.
    """
    values = request.get("values") or {}
    p = author.changed(values)
    m = author.build(p)
    vary = request.get("vary") or _all_lengths(author, values)
    last, leader = 0.0, None

    def build(**numbers: Any) -> Mechanism:
        return author.build(author.changed(values | numbers))

    def progress(done: float, error: float) -> None:
        nonlocal last, leader
        now = time.monotonic()
        if done >= 1.0 or now - last >= PERIOD:
            last = now
            reply({"kind": "progress", "done": done, "error": error, "values": leader})
            leader = None

    def better(values_so_far: dict[str, Any], _: float) -> None:
        nonlocal leader
        leader = values | in_digits(values_so_far)

    try:
        fit = fit_path(
            m, request["path"], {name: tuple(bounds) for name, bounds in vary.items()}, point=request.get("point"),
            closed=bool(request.get("closed")), ordered=bool(request.get("ordered")), build=build,
            grashof=bool(request.get("grashof")),
            least_transmission=float(request.get("least_transmission") or 0.0), starts=int(request.get("starts") or 2),
            seed=int(request.get("seed") or 0), generations=int(request.get("generations") or 60), progress=progress,
            better=better,
        )  # fmt: skip
    except MechanismError as error:
        raise UserError(str(error)) from error
    fitted_values = values | in_digits(fit.values)
    reply(
        {
            "kind": "fitted",
            "values": fitted_values,
            "mean": fit.mean,
            "largest": fit.largest,
            "least_transmission": fit.least_transmission,
            "path": fit.path.round(9).tolist(),
        }
    )


def _all_lengths(author: Author, values: dict[str, float]) -> dict[str, tuple[float, float]]:
    names, _ = lengths(author, values)
    ranges = {number.name: (number.low, number.high) for number in numbers_of(author.changed(values))}
    moving = {name: ranges[name] for name in names if ranges[name][0] < ranges[name][1]}
    if not moving:
        raise UserError(f"{author.name}: Params has no number that changes a length; there is nothing to fit")
    return moving
