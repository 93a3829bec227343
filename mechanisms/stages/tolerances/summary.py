"""What was found, for people: a sentence a result for the terminal, and summary.md."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mbsd import Tolerances

NOTHING = 0.01
"""Part of the standard deviation, and of the yield, that is not worth a tighter tolerance."""


def sentence(result: str, t: Tolerances) -> str:
    """How far it strays, how many are good, and which dimension to tighten."""
    return f"{result}: {_spread(t)}; {advice(t)}"


def _spread(t: Tolerances) -> str:
    within = "" if t.yields is None else f", {t.yields.part:.2%} within limits"
    failed = f", {len(t.failed)} of {len(t)} machines fail" if len(t.failed) else ""
    return f"{t.mean:.6g} +- {3 * t.std:.3g} (three standard deviations){within}{failed}"


def advice(t: Tolerances) -> str:
    """Which dimension to tighten first, and what that brings."""
    best = t.tighten[0]
    gain = 1.0 - best.std_halved / t.std if t.std > 0.0 else 0.0
    more = 0.0 if t.yields is None else best.yield_halved - t.yields.part
    if t.yields is not None and t.yields.part == 1.0:
        return "all are good, so nothing is to be tightened"
    if max(gain, more) < NOTHING:
        return "no dimension alone makes a difference if its tolerance is halved"
    of_yield = "" if t.yields is None else f" and {best.yield_halved:.2%} are within limits"
    return f"tighten '{best.name}' first: with half its tolerance it strays {gain:.0%} less{of_yield}"


def page(name: str, results: Mapping[str, Tolerances]) -> str:
    """summary.md: a section a result."""
    parts = [f"# Tolerances of {name}\n"]
    for result, t in results.items():
        advised = advice(t)
        parts += [f"## {result}\n", f"{advised[0].upper()}{advised[1:]}.\n", f"![{result}]({result}.svg)\n"]
        parts += [f"```text\n{t}\n```\n"]
    return "\n".join(parts)
