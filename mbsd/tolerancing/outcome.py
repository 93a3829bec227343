"""Outcome of :func:`mbsd.tolerances`: numbers of the result, and a row for each dimension."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.files import csv_text, write_whole
from mbsd.base.names import Suggesting
from mbsd.tolerancing.dimensions.dimension import Dimension
from mbsd.tolerancing.statistics import Halving, Limits, Sobol, Yield, parts, yield_of

if TYPE_CHECKING:
    from mbsd.pictures import Picture


QUANTILES = (0.00135, 0.025, 0.25, 0.5, 0.75, 0.975, 0.99865)
"""Quantiles; the first and the last are those of -3 and 3 standard deviations of a normal distribution."""


class Row(NamedTuple):
    """A dimension: what it does, and what it would bring to halve its tolerance, or its play."""

    name: str
    nominal: float
    low: float
    """Lower limit of its deviation, or least play, as ``high``."""
    high: float
    slope: float
    """Change of the result for a unit of the dimension; of a pin that lies anywhere, at most."""
    share: float
    """Part of the variance, by first derivatives."""
    worst: float
    """Its part in the worst case, to either side."""
    std_halved: float
    """Standard deviation of the result if it is halved."""
    yield_halved: float
    """Yield if it is halved; NaN without limits."""
    sobol_first: float
    """Sobol's index of first order, as ``sobol_total``; NaN unless asked for."""
    sobol_total: float


@dataclass(frozen=True, eq=False)
class Tolerances(Suggesting):
    """The result of n machines that stray, in its own unit."""

    values: np.ndarray
    """(n,) NaN where a machine failed."""
    deviations: np.ndarray
    """(n, columns) of each machine, by ``columns``: from nominal sizes, or places of pins in their bores (m)."""
    columns: tuple[str, ...]
    nominal: float
    """Result of the machine as it was given, without play."""
    linear_std: float
    """Standard deviation by first derivatives, where squares add up."""
    linear_worst: tuple[float, float]
    """Least and largest result by first derivatives, with all dimensions at their limits."""
    vertex_worst: tuple[float, float] | None
    """The same, of machines at the corners and in the middle of all tolerances; None where they were not solved."""
    corners_failed: int
    """Number of corners that failed, so that there is no worst case there but the mechanism itself."""
    limits: Limits | None
    confidence: float
    failures: Mapping[str, int]
    """Number of failed mechanisms by reason."""
    halving: Halving
    """Gain of halving each tolerance."""
    sobol: Sobol | None
    way: str
    """Method by which the mechanisms were solved, and the place of pins with play."""
    name: str
    dimensions: tuple[Dimension, ...]
    slopes: np.ndarray
    """(columns,) first derivatives of the result."""
    shares: np.ndarray
    """(d,) parts of the variance by first derivatives."""
    quantity: str = "result"
    """Name of the result: a quantity, or a function."""

    def __len__(self) -> int:
        return len(self.values)

    @property
    def good(self) -> np.ndarray:
        """(n,) which did not fail."""
        return np.isfinite(self.values)

    @property
    def failed(self) -> np.ndarray:
        """Numbers of the machines that failed; their deviations are ``deviations[failed]``."""
        return np.flatnonzero(~self.good)

    @property
    def curved(self) -> bool:
        """Return True if first derivatives miss the standard deviation.

        Shares and the worst case by them then mislead.
        """
        return self.halving.again

    @property
    def mean(self) -> float:
        """Mean of the machines that did not fail, as all that follows."""
        return float(self.values[self.good].mean())

    @property
    def std(self) -> float:
        """Standard deviation."""
        return float(self.values[self.good].std(ddof=1))

    def quantile(self, part: float) -> float:
        """Return the result that a ``part`` of the mechanisms does not exceed.

        Raises ModelError for a part beyond 0 .. 1.
        """
        if isinstance(part, bool) or not isinstance(part, int | float) or not 0.0 <= part <= 1.0:
            raise ModelError(f"{self.name}: tolerances: quantile: part is {part!r}; it must be from 0 to 1")
        return float(np.quantile(self.values[self.good], part))

    @property
    def quantiles(self) -> dict[float, float]:
        """At -3 and 3 standard deviations of a normal distribution, the middle, and those between."""
        return {part: self.quantile(part) for part in QUANTILES}

    @property
    def yields(self) -> Yield | None:
        """Return the part of all mechanisms within the limits with its Wilson interval.

        Those that failed are not within.
        """
        return None if self.limits is None else yield_of(self.values, self.limits, self.confidence)

    @property
    def rows(self) -> list[Row]:
        """A row a dimension, in the order in which they were named."""
        out = []
        for k, (dimension, part) in enumerate(zip(self.dimensions, parts(self.dimensions), strict=True)):
            slopes = self.slopes[part]
            first, total = (np.nan, np.nan) if self.sobol is None else (self.sobol.first[k], self.sobol.total[k])
            slope = float(slopes[0]) if len(slopes) == 1 else float(np.hypot(*slopes))
            out.append(
                Row(
                    dimension.label, dimension.nominal, *dimension.limits, slope * dimension.per_unit,
                    float(self.shares[k]), dimension.swing(slopes), float(self.halving.std[k]),
                    float(self.halving.within[k]), float(first), float(total),
                )
            )  # fmt: skip
        return out

    @property
    def tighten(self) -> list[Row]:
        """The same, what brings most first: by the standard deviation that halving a tolerance leaves."""
        return sorted(self.rows, key=lambda row: row.std_halved)

    def table(self) -> Any:
        """A pandas DataFrame, a row a dimension, in the order of :attr:`tighten`. Needs the extra ``pandas``."""
        try:
            import pandas
        except ImportError as error:
            raise ModelError("table needs pandas: install mbsd[pandas]") from error
        return pandas.DataFrame(self.tighten)

    def to_csv(self, path: str | os.PathLike[str], machines: bool = False) -> None:
        """Write the rows of :attr:`tighten`, or all ``machines``, their deviations and results."""
        if machines:
            rows = np.column_stack([self.deviations, self.values]).tolist()
            text = csv_text([*self.columns, "result"], rows)
        else:
            rows = [[value if isinstance(value, str) else float(value) for value in row] for row in self.tighten]
            text = csv_text(Row._fields, rows)
        write_whole(path, text.encode())

    def plot(self, ax: Any = None) -> Picture:
        """The distribution with its limits, and the share of each dimension. ``ax``: two axes. Needs ``draw``."""
        from mbsd.drawing.tolerances import draw_tolerances

        return draw_tolerances(self, ax)

    def __repr__(self) -> str:
        failed = f", {len(self.failed)} failed" if len(self.failed) else ""
        within = "" if self.yields is None else f", {self.yields.part:.2%} within limits"
        return f"<Tolerances of {self.name}: {len(self)} machines{failed}, {self.mean:.6g} +- {self.std:.3g}{within}>"

    def __str__(self) -> str:
        from mbsd.tolerancing.outcome import report

        return report(self)


TITLES = ("dimension", "share", "worst +-", "std if halved")


def report(t: Any) -> str:
    """The lines of a Tolerances."""
    lines = [
        f"{t.name}: {len(t)} machines, {t.way}",
        f"nominal {t.nominal:.7g}, mean {t.mean:.7g}",
        f"standard deviation {t.std:.4g} ({t.linear_std:.4g} by derivatives)",
        f"99.73 % from {t.quantile(0.00135):.7g} to {t.quantile(0.99865):.7g}",
        f"worst case {_from_to(t.linear_worst)} by derivatives"
        + ("" if t.vertex_worst is None else f", {_corners(t)}"),
    ]
    if t.curved:
        lines.append(
            "the result is curved within the tolerances: shares and worst case by derivatives mislead; sobol=True"
        )
    if t.yields is not None:
        part, low, high = t.yields
        lines.append(f"within limits {part:.2%} ({t.confidence:.0%}: {low:.2%} to {high:.2%})")
    lines += [f"{count} machines failed: {reason}" for reason, count in t.failures.items()]
    return "\n".join([*lines, *_table(t)])


def _table(t: Any) -> list[str]:
    """The dimensions, what brings most first."""
    rows = t.tighten
    wide = max(len(TITLES[0]), *(len(row.name) for row in rows))
    sobol, limited = t.sobol is not None, t.limits is not None
    out = [
        f"{TITLES[0]:{wide}} {TITLES[1]:>7} {TITLES[2]:>10} {TITLES[3]:>14}"
        + limited * "  yield if halved"
        + sobol * "  Sobol, total"
    ]
    for row in rows:
        line = f"{row.name:{wide}} {row.share:7.1%} {row.worst:10.3g} {row.std_halved:14.4g}"
        line += f" {row.yield_halved:16.2%}" if limited else ""
        out.append(line + (f" {row.sobol_total:13.1%}" if sobol else ""))
    return out


def _corners(t: Any) -> str:
    if t.corners_failed == 2 ** len(t.dimensions):
        return f"unknown at the corners: all {t.corners_failed} of them fail"
    failed = f", of which {t.corners_failed} fail" if t.corners_failed else ""
    return f"{_from_to(t.vertex_worst)} at the corners{failed}"


def _from_to(limits: tuple[float, float]) -> str:
    return f"{limits[0]:.7g} to {limits[1]:.7g}"
