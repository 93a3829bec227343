"""Sentences of an article as Markdown: insights, things that show themselves, numbers that move."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np

from render.article.quantities import KINDS, address, degrees, series_of
from render.insights import Insight, insights
from render.insights.insight import Amount, Named, Sort, Value, listed, said, sentences
from render.insights.meeting import happening
from render.insights.seen import Output, Seen
from shared.contract import Motion, Parts
from shared.contract.clearance import Clearance
from shared.contract.quantity import live

# A paragraph and what is bound to it, as its last line in braces:
#
#     The wheel rests for 75 % of the time, locked, while [the crank](show:body/crank) turns on through 270°.
#     {at=1.25 to=2.75 curve=body/wheel/theta near=joint/index}
#
# at, to (s): the moment at which the machine stands, or from where it plays; arrows: words of what is shown; curve: the
# series beside it; near: what the camera looks at; apart, 0 .. 1; speed: 1 as the film; variant: another motion.

LANGUAGES = Path(__file__).parent
LIMITS = ("dead_point", "change_point", "transmission", "pressure_angle", "toggle", "limit", "impact", "sticking")
"""Kinds of insights into what could stop it."""
MOTION = (
    "dwell", "quick_return", "straight_line", "step", "scale", "ellipse", "speed_ratio", "orbit", "swing", "mirror",
    "level", "cosine", "halves", "whirl", "rolls", "cusp", "crossing", "changing_ratio", "speed_peak", "difference",
    "slide", "rhythm", "returns", "climbs",
)  # fmt: skip
"""Kinds of insights into how it moves that may be its trick."""
SORTS = {"body": ("body",), "joint": ("joint",), "point": ("point",), "load": ("driver", "force", "contact")}
"""Kinds of things that a name in a sentence may be."""
WHOLE = 0.95
"""Part of the motion: an insight over more of it is bound to all of it."""
SEVERAL = 6
"""Names that are listed one by one, at most."""
SPACE = "\N{NO-BREAK SPACE}"
"""Between a number and its unit."""


@dataclass(frozen=True)
class Machine:
    """All that an article tells of."""

    name: str
    description: str
    motion: Motion
    payload: dict[str, Any]
    parts: Parts | None = None
    clearance: Clearance | None = None
    designs: Mapping[str, Any] = field(default_factory=dict)
    """Header of the table of designs; empty if no number can be moved."""
    variants: Mapping[str, Motion] = field(default_factory=dict)

    @cached_property
    def seen(self) -> Seen:
        """The motion as insights see it."""
        return Seen(self.motion)

    @cached_property
    def insights(self) -> list[Insight]:
        """Insights, the most telling first."""
        return insights(self.motion)


def words(language: str = "en") -> dict[str, dict[str, str]]:
    """Return the tables of words of a language: steps, words, kinds, why."""
    return tomllib.loads((LANGUAGES / f"{language}.toml").read_text("utf-8"))


def escaped(text: str) -> str:
    """Return text that Markdown shows as it is."""
    return re.sub(r"([\\`*_\[\]<>{}#!|~&])", r"\\\1", text)


def link(text: str, target: str) -> str:
    """Return a link of Markdown."""
    return f"[{escaped(text)}](<{target}>)"


def code(name: str) -> str:
    """Return a name as an address has it."""
    return quote(name, safe="")


def bound(text: str, **scene: Any) -> str:
    """Return a paragraph with what is bound to it."""
    rows = [f"{key}={quote(f'{value:.6g}' if isinstance(value, float) else str(value), safe='/,.-%')}"
            for key, value in scene.items() if value not in (None, "", ())]  # fmt: skip
    return f"{text}\n{{{' '.join(rows)}}}" if rows else text


class Sentences:
    """Writer of sentences about one machine."""

    def __init__(self, machine: Machine) -> None:
        self.machine, self.motion, self.seen = machine, machine.motion, machine.seen
        tables = words()
        self.titles, self.words, self.kinds, self.why = (tables[key] for key in ("steps", "words", "kinds", "why"))
        self.plain = sentences("en")
        self._explained: set[str] = set()

    # Things, numbers and moments.

    def body(self, name: str) -> str:
        """Return a body as a sentence has it, which shows the body."""
        return self._said(Named("body", (name,)), self.plain)

    def joint(self, name: str) -> str:
        """Return a joint as a sentence has it, which shows the joint."""
        return self._said(Named("joint", (name,)), self.plain)

    def count(self, number: int) -> str:
        """Return a count in words, a large one in figures."""
        return self.plain.get(f"|{number}", str(number))

    def reading(self, measure: str, kind: str, name: str, series: str) -> str:
        """Return a number that follows the machine."""
        where = address(kind, name, series)
        return link(series_of(self.machine.payload, where).words(measure), f"{measure}:{where}")

    def moment(self, value: Amount, at: float | None) -> str:
        """Return a moment that goes to its time (s)."""
        text = said(value, self.plain)
        return escaped(text) if at is None else link(text, f"at:{at:.6g}")

    def _said(self, value: Value, table: Mapping[str, str], each: Insight | None = None) -> str:
        """Return a value of a sentence as Markdown: things show themselves, moments go there."""
        text = said(value, table)
        if isinstance(value, Named) and not value.each:
            return listed([self._shown(value.sort, name, table) for name in value.names], table["|and"])
        if isinstance(value, Amount) and value.unit in ("place", "s") and each is not None:
            return self.moment(value, self._time_of(value, each))
        return escaped(text.replace(" ", SPACE) if isinstance(value, Amount) else text)

    def _shown(self, sort: Sort, name: str, table: Mapping[str, str]) -> str:
        text, kind = said(Named(sort, (name,)), table), self._kind(sort, name)
        return link(text, f"show:{address(kind, name)}") if kind else escaped(text)

    def _kind(self, sort: str, name: str) -> str:
        """Return the kind of a name on the page; empty if the page lacks it."""
        return next((kind for kind in SORTS[sort] if name in self.machine.payload[KINDS[kind]]), "")

    def _time_of(self, value: Amount, each: Insight) -> float | None:
        """Return the time (s) of a moment in a sentence; None of a duration."""
        if value.unit == "s":
            return value.value if value.value in (each.start, each.end) else None
        rows, crank = self.seen.window(), self.seen.input
        if crank is None or not crank.turns:
            return None
        angle = crank.value[rows] - crank.value[rows][0]
        away = (self.seen.theta_sign * value.value - crank.value[rows][0]) % (2 * math.pi)
        return float(np.interp(away, angle, self.seen.time[rows]))

    # Paragraphs.

    def paragraphs(self, rows: Sequence[Insight], is_near: bool = False, arrows: str = "") -> Iterator[str]:
        """Yield a paragraph for each insight: its sentence, and what it means the first time."""
        for each in rows:
            text = each.sentence(say=lambda value, table, each=each: self._said(value, table, each))
            why = self.why.get(each.template, "")
            if why and why not in self._explained:
                self._explained.add(why)
                text += f" {why}"
            is_whole = each.end - each.start > WHOLE * self.seen.span
            yield bound(
                text,
                at=None if is_whole else each.start,
                to=None if is_whole or each.end <= each.start else each.end,
                arrows=arrows,
                curve=self._curve_of(each),
                near=self._near(each) if is_near else None,
            )

    def dragged(self, outputs: Sequence[str]) -> str:
        """Return a sentence with the crank's angle, or the time, to drag."""
        crank, rest = self.seen.input, listed(outputs)
        if crank is None or crank.name not in self.motion.drivers:
            start = live(self.seen.time, "s", 3)(float(self.seen.time[0]))
            return self.words["drag_time"].format(time=link(start, "time:"), outputs=rest)
        value = np.asarray(self.motion.drivers[crank.name].value)
        first = float(value[0])
        text = degrees(first % (2 * math.pi)) if crank.unit == "rad" else live(value, crank.unit, 3)(first)
        angle = link(text, f"turn:{code(crank.name)}")
        return self.words["drag_turn"].format(crank=self.body(crank.body), angle=angle, outputs=rest)

    def stands(self, output: Output) -> str:
        """Return where an output stands at the moment, or how fast it moves."""
        key, series = ("runs", "speed") if output.slides else ("stands", "theta")
        value = self.reading("now", "body", output.body, series)
        return self.words[key].format(body=self.body(output.body), value=value)

    def outcomes(self) -> list[str]:
        """Return what follows from the numbers: travels, and the largest reaction."""
        rows = []
        for output in self.seen.outputs[:2]:
            if output.slides or output.travel < 2 * math.pi:
                series = self.curve_of_body(output.body).split("/")[2]
                travel = self.reading("range", "body", output.body, series)
                key = "slides" if output.slides else "swings"
                rows.append(self.words[key].format(body=self.body(output.body), travel=travel))
        if most := self.heaviest:
            force = self.reading("most", "joint", most, "size")
            rows.append(self.words["most"].format(joint=self.joint(most), force=force))
        return rows

    def joints(self) -> Iterator[str]:
        """Yield joints by kind: ``four pins (A, B, C and D)``."""
        groups: dict[str, list[str]] = {}
        for name, joint in self.motion.joints.items():
            groups.setdefault(joint.pair or joint.kind, []).append(name)
        for kind, names in groups.items():
            single, plural = self.kinds.get(kind, [kind.replace("_", " "), f"{kind.replace('_', ' ')}s"])
            shown = [self._shown_joint(name) for name in names]
            suffix = f" ({listed(shown)})" if len(names) <= SEVERAL and names != [single] else ""
            yield f"{self.count(len(names))} {escaped(single if len(names) == 1 else plural)}{suffix}"

    def _shown_joint(self, name: str) -> str:
        text, is_there = name.replace("_", " "), name in self.machine.payload["joints"]
        return link(text, f"show:{address('joint', name)}") if is_there else escaped(text)

    # What is bound to a paragraph.

    @cached_property
    def curve(self) -> str:
        """Series of a paragraph that is about nothing else."""
        for output in self.seen.outputs:
            return self.curve_of_body(output.body)
        for name in self.motion.points:
            return address("point", name, "speed")
        return self.curve_of_body(next(iter(self.motion.bodies))) if self.motion.bodies else ""

    @cached_property
    def heaviest(self) -> str:
        """Joint that carries most; empty if none carries more than rounding."""
        sizes = {
            name: float(np.hypot(joint.fx, joint.fy).max())
            for name, joint in self.motion.joints.items()
            if joint.pair and name in self.machine.payload["joints"]
        }
        most = max(sizes, key=lambda name: sizes[name], default="")
        return most if most and sizes[most] > self.seen.floors["N"] else ""

    @cached_property
    def loads(self) -> list[str]:
        """Drivers that give more than nothing."""
        return [name for name, driver in self.motion.drivers.items() if driver.effort_unit and np.any(driver.effort)]

    def curve_of_body(self, name: str) -> str:
        """Return the series that tells of a body: its angle, or its way along the longer axis."""
        body = self.motion.bodies[name]
        if np.ptp(body.theta) > 1e-6:
            return address("body", name, "theta")
        return address("body", name, "x" if np.ptp(body.x) > np.ptp(body.y) else "y")

    def _curve_of(self, each: Insight) -> str:
        if each.kind == "period":
            return self.curve
        if each.kind == "speed_peak":
            name = each.bodies[-1]
            return address("body", name, "omega" if np.ptp(self.motion.bodies[name].theta) > 1e-6 else "speed")
        for name in each.joints:
            for sort, series in (("joint", "size"), ("point", "speed"), ("load", "effort")):
                kind = self._kind(sort, name)
                if kind and not (kind == "joint" and is_of(each, MOTION)):
                    return address(kind, name, "normal" if kind == "contact" else series)
        for name in reversed(each.bodies) if is_of(each, LIMITS) else each.bodies:
            if name in self.machine.payload["bodies"]:
                return self.curve_of_body(name)
        return address("driver", self.loads[0], "effort") if self.loads else self.curve

    def _near(self, each: Insight) -> str:
        """Return what the camera looks at: a place of the insight, else where most happens between its bodies."""
        for name in each.joints:
            for sort in ("point", "joint"):
                if kind := self._kind(sort, name):
                    return address(kind, name)
        joints = [
            name
            for name, joint in self.motion.joints.items()
            if name in self.machine.payload["joints"] and sum(body in each.bodies for body in joint.bodies) > 1
        ]
        most = max(joints, key=lambda name: float(happening(self.motion, name).max()), default="")
        return address("joint", most) if most else ""


def is_of(insight: Insight, kinds: tuple[str, ...]) -> bool:
    """Return True if an insight is of one of some kinds of insights."""
    kind = insight.kind
    return kind in kinds


def prose(text: str) -> str:
    """Return a docstring's words as Markdown; text in backticks is code."""
    parts = re.split(r"(`+[^`]+`+)", text)
    return "".join(part if k % 2 else escaped(part) for k, part in enumerate(parts))
