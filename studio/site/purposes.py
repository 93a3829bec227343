"""Purposes of a mechanism as filters of the wall, from its docstring and the kinds of data.json."""

from __future__ import annotations

import re

from shared.contract import Motion

WORDS = {
    "walks": r"\bwalk",
    "lifts": r"\blift",
    "locks": r"\block|\bdwell|\brests? while|toggle",
    "turns into straight": r"straight",
    "clamps and presses": r"\bclamp|\bpress",
    "quick return": r"quick return|quick-return|returns? (?:faster|quickly)",
    "drives a vehicle": r"\bsteer|\bcar\b|\bwheel rolls|\bvehicle|\bbicycle",
    "swings": r"\bpendul|\bswings?\b",
    "shakes": r"\bvibrat|\bshak|\bbalanc",
    "human body": r"\bthigh|\bknee|\bathlete|\bhip\b",
}
"""Purposes, and how a docstring speaks of them."""
ENGINE = re.compile(r"\bengine\b|\bcylinder", re.IGNORECASE)
KINDS = {
    "gears": ("gear", "rack"),
    "belts and chains": ("belt", "chain"),
    "cams": ("cam", "geneva", "curve"),
    "springs": ("spring",),
    "impacts": ("impact", "contact", "limit"),
}
"""Parts of machines, by what the names of kinds in data.json begin with or hold."""
COMMON = 2
"""A filter of fewer machines is none."""


def purposes(name: str, said: str, motion: Motion) -> list[str]:
    """Return the filters that match a mechanism, in the order of the lists above."""
    text = f"{name.replace('_', ' ')}. {said}"
    out = [purpose for purpose, pattern in WORDS.items() if re.search(pattern, text, re.IGNORECASE)]
    if ENGINE.search(text):
        out.append("engines")
    things = (motion.joints, motion.drivers, motion.forces, motion.contacts)
    kinds = {thing.kind for group in things for thing in group.values()}
    out += [part for part, stems in KINDS.items() if any(stem in kind for kind in kinds for stem in stems)]
    return out


def filters(purposes_of: dict[str, list[str]]) -> list[str]:
    """Return purposes that at least COMMON mechanisms have, the most common ones first."""
    counts: dict[str, int] = {}
    for each in purposes_of.values():
        for purpose in each:
            counts[purpose] = counts.get(purpose, 0) + 1
    return sorted((purpose for purpose in counts if counts[purpose] >= COMMON), key=lambda word: (-counts[word], word))


def neighbours(name: str, purposes_of: dict[str, list[str]], most: int = 4) -> list[str]:
    """Return the mechanisms that share most with this one.

    Of equals those with fewer purposes of their own come first, then by name.
    """
    ours = set(purposes_of[name])

    def likeness(other: str) -> float:
        theirs = set(purposes_of[other])
        return len(ours & theirs) / max(1, len(ours | theirs))

    others = sorted((other for other in purposes_of if other != name), key=lambda other: (-likeness(other), other))
    return others[:most]
