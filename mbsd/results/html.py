"""A solution in a notebook: what was solved, and the least and the largest value of each result."""

from __future__ import annotations

import html
from collections.abc import Mapping

import numpy as np

LEFT_OUT = (".ax [m/s^2]", ".ay [m/s^2]", ".vx [m/s]", ".vy [m/s]")
"""Ends of the names of results that the table does not show."""


def html_of(name: str, about: str, columns: Mapping[str, np.ndarray], moving: str) -> str:
    """HTML: a mechanism's name, what is said ``about`` it, the HTML of its skeleton ``moving``, and its results."""
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
