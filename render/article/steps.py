"""The text of an article from a machine's files: eight steps as Markdown, an insight a paragraph."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from render.article.quantities import address
from render.article.sentences import (
    LIMITS,
    MOTION,
    SEVERAL,
    SPACE,
    Machine,
    Sentences,
    bound,
    code,
    escaped,
    link,
    prose,
)
from render.insights import Insight, insights
from render.insights.insight import Named, capital, listed, said
from render.view.payload import title_of
from shared.contract.quantity import written

WAYS = ("stroke", "reach", "even_return", "period")
"""Kinds that tell of ways and times, but are no trick."""
UNTOLD = ("bend",)
"""Kinds that an article leaves out."""
MOST = {"trick": 2, "turn": 3, "forces": 4, "limit": 3}
"""Insights of a step, at most."""
ARROWS = "reactions,forces"
PLATE = 0.22
"""Side of a printer's plate (m)."""
SCALES = (2, 5, 10, 20, 50, 100, 200, 500)
SLOW = 0.25
"""Speed of a step in which one drags; 1 is that of the film."""
NEAR = 0.02
"""Margin of a pose near a singular one."""


@dataclass(frozen=True)
class Step:
    """One step: its heading and its paragraphs, Markdown."""

    key: str
    title: str
    paragraphs: list[str]

    def markdown(self) -> str:
        """Return the step as the author's file has it."""
        return "\n\n".join([f"## {self.title} {{#{self.key}}}", *self.paragraphs]) + "\n"


def markdown(machine: Machine, steps: Iterable[Step]) -> str:
    """Return the whole text, as an author may put it beside mechanism.py and change it."""
    return "\n".join([f"# {escaped(title_of(machine.name))}\n", *(step.markdown() for step in steps)])


def steps_of(machine: Machine) -> list[Step]:
    """Return the steps that have something to say."""
    writer = _Steps(machine)
    crank = machine.seen.input
    turn = writer.titles["turn" if crank is not None and crank.turns else "run"]
    written = {
        "what": writer.what(),
        "parts": writer.parts(),
        "turn": writer.turn(),
        "trick": writer.paragraphs(writer.tricks, is_near=True),
        "forces": writer.forces(),
        "limit": writer.limit(),
        "variants": writer.variants(),
        "print": writer.printed(),
    }
    steps = [Step(key, turn if key == "turn" else writer.titles[key], list(rows)) for key, rows in written.items()]
    return [step for step in steps if step.paragraphs]


class _Steps(Sentences):
    def __init__(self, machine: Machine) -> None:
        super().__init__(machine)
        first: dict[str, Insight] = {}
        for each in machine.insights:
            first.setdefault(each.kind, each)
        self.by_kind, self.insights = first, list(first.values())
        moving = [each for kind, each in first.items() if kind in MOTION]
        self.tricks = moving[: MOST["trick"]]
        self.ways = [*moving[MOST["trick"] :], *(each for kind, each in first.items() if kind in WAYS)]

    def what(self) -> Iterator[str]:
        """Yield the docstring and how the article is used."""
        for paragraph in re.split(r"\n\s*\n", re.sub(r"\s*\bSI units\.", "", self.machine.description)):
            if paragraph.strip():
                yield bound(prose(" ".join(paragraph.split())), curve=self.curve)
        yield bound(self.words["use"], curve=self.curve)

    def parts(self) -> Iterator[str]:
        """Yield bodies, joints, and what drives it."""
        names = [self.body(name) for name in self.motion.bodies]
        shown = names if len(names) <= 2 * SEVERAL else [*names[: 2 * SEVERAL], "more"]
        key = "body" if len(names) == 1 else "bodies"
        rows = [self.words[key].format(count=self.count(len(names)), names=listed(shown))]
        if joints := list(self.joints()):
            rows.append(self.words["joints"].format(joints=capital(listed(joints))))
        crank = self.seen.input
        if self.motion.analysis == "sweep" and crank is not None and len(self.motion.drivers) == 1:
            key = "one_angle" if crank.unit == "rad" else "one_place"
            rows.append(self.words[key].format(body=self.body(crank.body)))
        elif not self.motion.drivers:
            rows.append(self.words["no_driver"])
        if mass := sum(body.mass for body in self.motion.bodies.values()):
            rows.append(self.words["weight"].format(mass=_number(mass, "kg")))
        yield bound(" ".join(rows), apart=0.6 if self.machine.payload["solid"] else None, curve=self.curve)

    def turn(self) -> Iterator[str]:
        """Yield the angle to drag, and ways and times."""
        outputs = self.seen.outputs[:2]
        if outputs:
            curve = self.curve_of_body(outputs[0].body)
            yield bound(self.dragged([self.stands(output) for output in outputs]), speed=SLOW, curve=curve)
        yield from self.paragraphs(self.ways[: MOST["turn"]])

    def forces(self) -> Iterator[str]:
        """Yield efforts, reactions, balance and energy; then those of the moment."""
        rows = [each for each in self.insights if each.kind not in (*MOTION, *WAYS, *LIMITS, *UNTOLD)]
        yield from self.paragraphs(rows[: MOST["forces"]], arrows=ARROWS)
        readings = []
        for name in self.loads[:1]:
            effort = self.reading("now", "driver", name, "effort")
            readings.append(self.words["gives"].format(load=said(Named("load", (name,)), self.plain), effort=effort))
        if most := self.heaviest:
            force = self.reading("now", "joint", most, "size")
            readings.append(self.words["carries"].format(joint=self.joint(most), force=force))
        if readings:
            curve = address("joint", most, "size") if most else self.curve
            yield bound(self.dragged(readings), speed=SLOW, arrows=ARROWS, curve=curve)

    def limit(self) -> Iterator[str]:
        """Yield dead points, angles and lengths beyond which it jams; else that there are none."""
        rows = [each for kind, each in self.by_kind.items() if kind in LIMITS]
        yield from self.paragraphs(rows[: MOST["limit"]])
        margin = np.asarray(self.motion.diagnostics.singularity_margin)
        if rows or not margin.size:
            return
        k = int(margin.argmin())
        at = float(self.seen.time[k])
        if margin[k] > NEAR:
            yield bound(self.words["no_limit"], curve=self.curve)
        else:
            yield bound(self.words["singular"].format(at=self.moment(self.seen.moment(at), at)), at=at)

    def variants(self) -> Iterator[str]:
        """Yield numbers to drag, and the author's variants beside it."""
        numbers, outcomes = self.machine.designs.get("numbers", []), self.outcomes()
        if numbers and outcomes:
            rows = [self._with(each) for each in numbers]
            efforts = f"{max(0.01, 100 * self.machine.designs['efforts']):.2g}{SPACE}%"
            exact = self.words["between"].format(
                places=_number(self.machine.designs["places"], "m", 2), efforts=efforts
            )
            text = f"{self.words['numbers'].format(numbers=listed(rows), outputs=listed(outcomes))} {exact}"
            yield bound(text, curve=address("joint", self.heaviest, "size") if self.heaviest else self.curve)
        kind = self.tricks[0].kind if self.tricks else ""
        for variant, motion in self.machine.variants.items():
            shown = insights(motion)
            first = next((each for each in shown if each.kind == kind), shown[0] if shown else None)
            title = capital(escaped(variant.replace("_", " ")))
            sentence = escaped(first.sentence()) if first else ""
            text = self.words["variant"].format(title=title, sentence=sentence).rstrip()
            yield bound(text, variant=code(variant), curve=self.curve)
        if not numbers and not self.machine.variants:
            yield self.words["no_numbers"].format(name=self.machine.name)

    def _with(self, number: Mapping[str, Any]) -> str:
        """Return a number to drag: ``a coupler of 120 mm``."""
        label = str(number["label"])
        key = "an" if label[:1].lower() in tuple("aeiou") else "a"
        value = link(_number(number["value"], number["unit"]), f"number:{code(number['name'])}")
        return self.words[key].format(label=escaped(label), value=value)

    def printed(self) -> Iterator[str]:
        """Yield the pieces, the largest one, and the least gap."""
        parts, name, solid = self.machine.parts, self.machine.name, self.machine.payload["solid"]
        if parts is None or solid is None:
            yield self.words["no_parts"].format(name=name)
            return
        if parts.schematic:
            yield bound(self.words["schematic"].format(why=escaped(parts.schematic)), apart=1.0)
            return
        pieces = [piece for body in parts.bodies.values() for piece in body.pieces.values() if not piece.dressing]
        bought = sum(bool(piece.buy) for piece in pieces)
        mass = sum(body.mass.mass for body in parts.bodies.values())
        rows = [self.words["pieces"].format(count=len(pieces) - bought, mass=_number(mass, "kg", 2))]
        rows += [self.words["bought"].format(count=bought)] if bought else []
        piece, (high, wide) = largest_piece(solid)
        whose = "the frame" if piece["body"] == "ground" else self.body(piece["body"])
        label = f"the {escaped(piece['name'].replace('_', ' '))} of {whose}"
        rows.append(self.words["largest"].format(piece=label, wide=_number(wide, "m"), high=_number(high, "m")))
        scale = next((f"1:{n}" for n in SCALES if wide / n <= PLATE), f"1:{SCALES[-1]}")
        rows.append(self.words["fits" if wide <= PLATE else "scaled"].format(name=name, scale=scale))
        if self.machine.clearance is not None and self.machine.clearance.pairs:
            gap = min(pair.proven for pair in self.machine.clearance.pairs)
            rows.append(self.words["proven"].format(gap=_number(gap, "m", 2)))
        yield bound(" ".join(rows), apart=1.0)


def _number(value: float, unit: str, digits: int = 3) -> str:
    return written(value, unit, digits).replace(" ", SPACE)


def largest_piece(solid: dict[str, Any]) -> tuple[dict[str, Any], tuple[float, float]]:
    """Return the largest piece of the page's solids, and its two longest sides (m), the shorter first."""

    def sides(piece: dict[str, Any]) -> list[float]:
        mesh = solid["meshes"][piece["mesh"]]
        steps = np.cumsum(mesh["positions"].reshape(3, -1), axis=1, dtype=np.uint16)
        return sorted(float(value) * solid["step"] for value in np.ptp(steps, axis=1))

    piece = max(solid["pieces"], key=lambda each: sides(each)[2])
    _, high, wide = sides(piece)
    return piece, (high, wide)
