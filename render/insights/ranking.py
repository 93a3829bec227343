"""Ranking of insights: by how telling each is.

    telling = weight of its kind * strength * novelty

The weight says how much a kind explains: what a mechanism is for (a dwell, a quick return, a straight line) before how
large something is. The strength, 0 .. 1, says how far the number is from what one expects: a return 1.8 times as fast
tells more than one 1.05 times as fast. The novelty halves with each insight of the same kind that ranks higher, so that
several kinds come first. What is below LEAST is left out. Insights that say the same of bodies with one stem (piston_1
.. piston_4) are one, on each of them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace

from render.insights.insight import Insight, Named, said, sentences, stem_of
from render.insights.kinds.energy import energy
from render.insights.kinds.loads import loads
from render.insights.kinds.passing import passing
from render.insights.kinds.paths import paths
from render.insights.kinds.ratios import ratios
from render.insights.kinds.shaking import balance
from render.insights.kinds.travel import travel
from render.insights.seen import Seen
from shared.contract import Motion

WEIGHTS = {
    "dwell": 1.0, "quick_return": 1.0, "straight_line": 1.0, "step": 1.0, "toggle": 1.0, "scale": 1.0, "ellipse": 0.9,
    "speed_ratio": 0.95, "orbit": 0.9, "swing": 0.9, "mirror": 0.85, "level": 0.9, "isolation": 0.9, "work_share": 0.9,
    "firing": 0.8, "balance": 0.85, "centre": 0.9, "couple": 0.7, "impact": 0.9, "sticking": 0.8, "losses": 0.8,
    "decay": 0.85, "roughness": 0.8, "changing_ratio": 0.9, "speed_peak": 0.8, "dead_point": 0.8, "change_point": 0.85,
    "transmission": 0.75, "pressure_angle": 0.8, "power_sign": 0.8, "peak_cause": 0.7, "effort_peak": 0.6,
    "peak_weight": 0.6, "ripple": 0.6, "gas": 0.75, "whirl": 0.7, "rolls": 0.7, "bend": 0.6, "cusp": 0.7,
    "crossing": 0.6, "no_effort": 0.7, "energy_kept": 0.6, "stroke": 0.55, "period": 0.5, "even_return": 0.4,
    "cable": 0.8, "rhythm": 0.8, "returns": 0.8, "climbs": 0.8,
    "difference": 0.9, "slide": 0.8, "cosine": 0.9, "halves": 0.8,
    "reach": 0.4, "limit": 0.4,
}  # fmt: skip
"""How much a kind explains, 0 .. 1."""
LEAST = 0.06
"""Insights that tell less are left out."""
ANEW = 0.5
"""Factor for each insight of the same kind that ranks higher."""


def insights(motion: Motion) -> list[Insight]:
    """Return what a motion shows, the most telling first."""
    seen = Seen(motion)
    chapters = (travel, ratios, paths, passing, loads, balance, energy)
    things = (motion.bodies, motion.joints, motion.points, motion.drivers, motion.forces, motion.contacts)
    names = [name for group in things for name in group]
    return ranked((each for chapter in chapters for each in chapter(seen)), names)


def ranked(findings: Iterable[Insight], names: Sequence[str]) -> list[Insight]:
    """Return insights by how telling they are, alike ones as one; ``names`` are all of the model."""
    weighed = [replace(each, telling=WEIGHTS[each.kind] * each.strength) for each in merged(list(findings), names)]
    times: dict[str, int] = {}
    out = []
    for each in sorted(weighed, key=lambda each: -each.telling):
        count = times.get(each.kind, 0)
        times[each.kind] = count + 1
        out.append(replace(each, telling=each.telling * ANEW**count))
    return [each for each in sorted(out, key=lambda each: -each.telling) if each.telling >= LEAST]


def merged(findings: list[Insight], names: Sequence[str]) -> list[Insight]:
    """Return insights, those that all bodies of one stem share as one on each of them."""
    stems = Counter(stem_of(name) for name in dict.fromkeys(names))
    groups: dict[tuple[str, ...], list[Insight]] = {}
    for each in findings:
        groups.setdefault(_without_numbers(each), []).append(each)
    out: list[Insight] = []
    for group in groups.values():
        each = _on_each(group)
        differing = [value for value in each.values.values() if isinstance(value, Named) and value.each]
        is_whole = all(len(value.names) == stems[stem_of(value.names[0])] for value in differing)
        out += [each] if is_whole else group
    return out


def _without_numbers(each: Insight) -> tuple[str, ...]:
    words = sentences("en")
    rows = list(each.bodies) if each.kind == "mirror" else []
    for key, value in each.values.items():
        if isinstance(value, Named) and len(value.names) == 1:
            rows.append(f"{key}: {value.sort} {stem_of(value.names[0])}")
        elif key != "at":
            rows.append(f"{key}: {said(value, words)}")
    return (each.template, *rows)


def _on_each(group: list[Insight]) -> Insight:
    """Return the first of a group, with the names that differ as each of their stem."""
    first = group[0]
    values = dict(first.values)
    for key, value in values.items():
        if isinstance(value, Named):
            alike = [each.values[key] for each in group]
            names = tuple(dict.fromkeys(name for each in alike if isinstance(each, Named) for name in each.names))
            values[key] = Named(value.sort, names, len(names) > 1 or value.each)
    bodies = tuple(dict.fromkeys(name for each in group for name in each.bodies))
    joints = tuple(dict.fromkeys(name for each in group for name in each.joints))
    return replace(first, bodies=bodies, joints=joints, values=values)
