"""The outcome in lines of text."""

from __future__ import annotations

from typing import Any

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
