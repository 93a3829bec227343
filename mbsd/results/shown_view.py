"""How the views of a solution show themselves: a few lines in a terminal, a small table in a notebook."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping
from dataclasses import fields
from html import escape
from types import MappingProxyType
from typing import Any

import numpy as np

from mbsd.base.names import Suggesting

UNITS = {
    "x": "m", "y": "m", "theta": "rad", "vx": "m/s", "vy": "m/s", "omega": "rad/s",
    "ax": "m/s^2", "ay": "m/s^2", "alpha": "rad/s^2", "fx": "N", "fy": "N", "torque": "N m",
    "kinetic": "J", "potential": "J", "total": "J", "power": "W",
}  # fmt: skip
"""Units of fields that always have the same."""


class ShownView(Suggesting):
    """A dataclass of arrays over time that shows how each begins and ends, and how far it goes."""

    other_words = MappingProxyType(
        {
            "angle": "theta",
            "position": "x",
            "velocity": "vx",
            "speed": "omega",
            "acceleration": "ax",
            "force_x": "fx",
            "force_y": "fy",
            "moment": "torque",
            "kinetic_energy": "kinetic",
            "potential_energy": "potential",
        }
    )

    def __repr__(self) -> str:
        rows = list(self._rows())
        outputs = next((len(array) for _, _, array in rows), 0)
        lines = [f"<{type(self).__name__}: {outputs} outputs"]
        for name, unit, array in rows:
            first, least, most, last = _numbers(array)
            lines.append(f"  {name:<13} {first:>10} .. {last:<10} least {least:>10}, most {most:>10} {unit}".rstrip())
        return "\n".join(lines) + ">"

    def _repr_html_(self) -> str:
        """The table of a notebook: a row for each quantity."""
        head = "".join(f"<th>{word}</th>" for word in ("", "unit", "first", "least", "most", "last"))
        body = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(unit)}</td>"
            + "".join(f"<td>{number}</td>" for number in _numbers(array))
            + "</tr>"
            for name, unit, array in self._rows()
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def _rows(self) -> Iterator[tuple[str, str, np.ndarray]]:
        """Name, unit and values of each array over time."""
        turning = getattr(self, "angular", None)
        for field in fields(self):  # type: ignore[arg-type]
            value: Any = getattr(self, field.name)
            if isinstance(value, np.ndarray) and value.ndim == 1 and len(value):
                yield field.name, UNITS.get(field.name) or _driven(field.name, turning), value


def _driven(name: str, angular: bool | None) -> str:
    """Units of a driver's numbers, which depend on what it drives."""
    if angular is None:
        return ""
    length = "rad" if angular else "m"
    return {"value": length, "rate": f"{length}/s", "acceleration": f"{length}/s^2",
            "effort": "N m" if angular else "N"}.get(name, "")  # fmt: skip


def _numbers(array: np.ndarray) -> list[str]:
    return [f"{number + 0.0:.4g}" for number in (array[0], np.nanmin(array), np.nanmax(array), array[-1])]


LEFT_OUT = (".ax [m/s^2]", ".ay [m/s^2]", ".vx [m/s]", ".vy [m/s]")
"""Ends of the names of results that the table does not show."""


def html_of(name: str, about: str, columns: Mapping[str, np.ndarray], moving: str) -> str:
    """Return HTML: a mechanism's name, text ``about`` it, its skeleton ``moving``, and its results."""
    rows = [
        (column, *(f"{end(values, initial=np.nan):.6g}" for end in (np.fmin.reduce, np.fmax.reduce)))
        for column, values in columns.items()
        if not column.endswith(LEFT_OUT)
    ]
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return (
        f"<p><b>{html.escape(name)}</b>: {html.escape(about)}</p>{moving}"
        "<details><summary>Least and largest values</summary>"
        "<table><tr><th>quantity</th><th>min</th><th>max</th></tr>"
        f"{body}</table></details>"
    )
