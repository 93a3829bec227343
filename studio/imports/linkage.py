"""Files of Linkage (.linkage2): XML with connectors and links, read leniently: some are malformed.

A unit is 1/96 inch times the drawing's scale. A positive rpm turns clockwise; an actuator extends and retracts at
constant speed, once in 60/cpm s (David Rector's Linkage, linkageDoc.cpp and Simulator.cpp of 2018).
"""

from __future__ import annotations

import math
import re
from html import unescape
from typing import Any

from shared.stage.errors import UserError
from studio.imports.limits import Titles, check_count, check_depth, check_length
from studio.imports.sketch import GROUND, Gears, Place, Ram, Sketch, Slide, Weld
from studio.imports.sketch import Motor as Drive

UNIT = 0.0254 / 96
"""m"""
USUAL = 15.0
"""rpm, and cycles a minute of an actuator, where the file says none."""
DRAWING = 1
"""The layer of what is drawn alone."""
HOLDERS = ("link", "element", "connector", "ratio")
"""Elements that hold references."""
TAG = re.compile(r"""<(/?)([a-z]\w*+)((?:[^<>"']|"[^"<]*+"|'[^'<]*+')*+)>""", re.IGNORECASE)
ATTRIBUTE = re.compile(r"""\b([a-z]\w*+)\s*+=\s*+(?:"([^"]*+)"|'([^']*+)'|([^\s"'/]++))""", re.IGNORECASE)
MOST_COMMENTS = 100


def is_linkage(text: str) -> bool:
    """True if a text is such a file."""
    return "<linkage2" in text[:2000].lower()


def read(text: str, name: str) -> Sketch:
    """Return the mechanism of such a file. Raises UserError if it has no links."""
    parsed = _Parsed(text)
    if not parsed.connectors or not parsed.links:
        raise UserError("the file has no links, so there is no mechanism to import")
    return _Reader(parsed, name).sketch


class _Parsed:
    """Elements by id; malformed text is passed over.

    Each tag is looked for no further than the next "<", so that the time grows with the length of the text alone.
    """

    def __init__(self, text: str) -> None:
        self.connectors: dict[str, dict[str, Any]] = {}
        self.links: dict[str, dict[str, Any]] = {}
        self.ratios: list[dict[str, Any]] = []
        self.program: dict[str, str] = {}
        self._open: list[dict[str, Any]] = []
        check_length(text)
        for tag in TAG.finditer(_without_comments(text)):
            closes, name, attributes = tag.groups()
            if closes:
                self._close(name.lower())
                continue
            given = {key.lower(): unescape("".join(values)) for key, *values in ATTRIBUTE.findall(attributes)}
            self._start(name.lower(), given)
            if attributes.rstrip().endswith("/"):
                self._open.pop()

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        """Open an element; inside another one it is a reference."""
        check_depth(len(self._open), f"element {tag}")
        kept: dict[str, Any] = attributes | {"tag": tag, "inside": []}
        if tag == "program":
            self.program = attributes
        outer = next((element for element in reversed(self._open) if element["tag"] in HOLDERS), None)
        if outer is not None:
            outer["inside"].append(kept)
            check_count(outer["inside"], f"things in one {outer['tag']}")
        elif tag == "connector":
            self.connectors.setdefault(kept.get("id", ""), kept)
        elif tag in ("link", "element"):
            self.links.setdefault(kept.get("id", ""), kept)
        elif tag == "ratio":
            self.ratios.append(kept)
        for things, words in ((self.connectors, "connectors"), (self.links, "links"), (self.ratios, "ratios")):
            check_count(things, words)
        self._open.append(kept)

    def _close(self, tag: str) -> None:
        """Close all open elements up to this tag, if it is open."""
        if any(element["tag"] == tag for element in self._open):
            while self._open.pop()["tag"] != tag:
                pass


def _without_comments(text: str) -> str:
    """Return a text without comments; a comment without an end reaches to the end."""
    parts = []
    while text:
        before, _, rest = text.partition("<!--")
        parts.append(before)
        if len(parts) > MOST_COMMENTS:
            raise UserError(f"it has more than {MOST_COMMENTS} comments")
        text = rest.partition("-->")[2]
    return "".join(parts)


class _Reader:
    def __init__(self, parsed: _Parsed, name: str) -> None:
        self.parsed = parsed
        self.sketch = Sketch(name, "Linkage")
        scale = int(_float(parsed.program.get("scalefactor"), 1.0)) or 1
        self.unit = UNIT * scale
        self.connectors = {key: element for key, element in parsed.connectors.items() if _counts(element)}
        self.labels = _labels(self.connectors, "P")
        self.link_labels = _labels(parsed.links, "L")
        self.members = self._members()
        self.bodies = {key: self._body(key) for key in self.members}
        self._links()
        self._pins()
        self._slides()
        self._motors()
        self._gears()
        self.sketch.inputs = len(self.sketch.motors) + len(self.sketch.rams)

    def place(self, connector: str) -> Place:
        element = self.connectors[connector]
        return _float(element.get("x")) * self.unit, _float(element.get("y")) * self.unit

    def _members(self) -> dict[str, list[str]]:
        """Return the connectors of each link that counts, with those of links fastened to it."""
        members = {}
        for key, element in self.parsed.links.items():
            if not _counts(element):
                continue
            inside = [ref.get("id", "") for ref in element["inside"] if ref["tag"] in ("connector", "fastenconnector")]
            members[key] = [ref for ref in dict.fromkeys(inside) if ref in self.connectors]
            if not members[key]:
                del members[key]
                self.sketch.left_out.append(f"link {self.link_labels[key]}: it has no connectors")
        for key, element in self.connectors.items():
            fastened = element.get("fastenlink") or element.get("fasten")
            if fastened in members and key not in members[fastened]:
                members[fastened].append(key)
        return members

    def _body(self, key: str) -> str:
        """Return the link's name, or the ground if it is fastened or all its connectors are anchors."""
        element, refs = self.parsed.links[key], self.members[key]
        anchored = [ref for ref in refs if _is(self.connectors[ref], "anchor")]
        turned = any(_is(self.connectors[ref], "input") for ref in anchored)
        held = element.get("fastenconnector")
        fast = (
            held in self.connectors and _is(self.connectors[held], "anchor") and not _is(self.connectors[held], "input")
        )
        if (len(anchored) > 1 and not turned) or fast:
            return GROUND
        if len(refs) == len(anchored) == 1 and not turned and not _is(element, "gear"):
            return GROUND
        return self.link_labels[key]

    def _links(self) -> None:
        for key, body in self.bodies.items():
            if body == GROUND or _is(self.parsed.links[key], "actuator"):
                continue
            link = self.sketch.link(body)
            for ref in self.members[key]:
                link.points.setdefault(self.labels[ref], self.place(ref))
            fastened = self.parsed.links[key].get("fastenlink")
            if fastened in self.bodies and fastened != key and not _is(self.parsed.links[fastened], "actuator"):
                place = self.place(self.members[key][0])
                other = self.bodies[fastened]
                self.sketch.joints.append(Weld(f"weld_{body}", other, body, place))
                if other != GROUND:
                    self.sketch.link(other)

    def _carriers(self, connector: str) -> list[str]:
        """Return the bodies on a connector, with the ground at an anchor; an actuator is no body."""
        bodies = [
            self.bodies[key]
            for key, refs in self.members.items()
            if connector in refs and not _is(self.parsed.links[key], "actuator")
        ]
        ground = [GROUND] if _is(self.connectors[connector], "anchor") else []
        return list(dict.fromkeys([*ground, *bodies]))

    def _pins(self) -> None:
        for key, label in self.labels.items():
            carriers = self._carriers(key)
            if len(carriers) > 1:
                self.sketch.pin_all(label, carriers, self.place(key))
            moving = [body for body in carriers if body != GROUND]
            if _is(self.connectors[key], "draw") and moving:
                self.sketch.traces[label] = (moving[0], self.place(key))
        for key, element in self.parsed.links.items():
            if _is(element, "actuator") and key in self.members:
                self._ram(key, element)

    def _ram(self, key: str, element: dict[str, Any]) -> None:
        label, refs = self.link_labels[key], self.members[key]
        ends = [(self._carriers(ref), ref) for ref in refs[:2]]
        if len(refs) != 2 or not all(carriers for carriers, _ in ends):
            self.sketch.left_out.append(
                f"actuator {label}: it has {len(refs)} connectors, or one that no other link carries"
            )
            return
        (first, a), (second, b) = ends
        places = self.place(a), self.place(b)
        stroke, cycles = _float(element.get("throw")) * self.unit, _float(element.get("cpm"), USUAL)
        self.sketch.rams.append(Ram(label, first[0], second[0], places, stroke, cycles / 60.0))
        self.sketch.left_out.append(
            f"actuator {label} moves at constant speed there, as a harmonic function of time here"
        )

    def _slides(self) -> None:
        for key, element in self.connectors.items():
            if not _is(element, "slider"):
                continue
            label = self.labels[key]
            limits = [ref.get("id", "") for ref in element["inside"] if ref["tag"] == "slidelimit"]
            limits = [limit for limit in limits if limit in self.connectors][:2]
            if len(limits) < 2:
                self.sketch.left_out.append(f"slider {label}: the file does not say between which connectors it slides")
                continue
            if _float(element.get("slideradius")):
                self.sketch.left_out.append(f"slider {label} runs on an arc; m.point_on_curve says that")
                continue
            guide = self._guide(*limits)
            riders = [body for body in self._carriers(key) if body != guide]
            if guide is None or not riders:
                self.sketch.left_out.append(
                    f"slider {label}: no link carries both ends of its way, or none rides on it"
                )
                continue
            (x0, y0), (x1, y1) = (self.place(limit) for limit in limits)
            angle = math.atan2(y1 - y0, x1 - x0)
            self.sketch.joints.append(Slide(label, guide, riders[0], self.place(key), angle, turns=True))

    def _guide(self, first: str, second: str) -> str | None:
        """Return the body that carries both ends of a way."""
        common = [body for body in self._carriers(first) if body in self._carriers(second)]
        return (GROUND if GROUND in common else common[0]) if common else None

    def _motors(self) -> None:
        for key, element in self.connectors.items():
            if not (_is(element, "input") and _is(element, "anchor")):
                if _is(element, "input"):
                    self.sketch.left_out.append(
                        f"input {self.labels[key]}: it is no anchor; m.drive_relative_angle says that"
                    )
                continue
            turned = [body for body in self._carriers(key) if body != GROUND]
            rate = -_float(element.get("rpm"), USUAL) * math.tau / 60.0
            for k, body in enumerate(turned):
                self.sketch.motors.append(
                    Drive(f"motor_{self.labels[key]}" + (f"_{k + 1}" if k else ""), GROUND, body, rate)
                )

    def _gears(self) -> None:
        for ratio in self.parsed.ratios:
            refs = [ref for ref in ratio["inside"] if ref.get("id") in self.bodies]
            if len(refs) != 2:
                continue
            keys = [ref["id"] for ref in refs]
            if not all(self.members[key] for key in keys):
                self.sketch.left_out.append("a pair of gears without centres")
                continue
            centres = [self.place(self.members[key][0]) for key in keys]
            sizes = [_float(ref.get("size"), 1.0) for ref in refs]
            if min(sizes) <= 0.0:
                self.sketch.left_out.append(f"gears {keys[0]} and {keys[1]}: a size is not above zero")
                continue
            apart, belt = math.dist(*centres), ratio.get("type") == "chains"
            unit = apart / sum(sizes) * (0.8 if belt else 1.0)
            if unit <= 0.0:
                self.sketch.left_out.append(
                    f"gears {keys[0]} and {keys[1]} have one centre; a weld or m.gear_pair says that"
                )
                continue
            bodies = [self.bodies[key] for key in keys]
            for body, key in zip(bodies, keys, strict=True):
                if body != GROUND:
                    self.sketch.link(body).points.setdefault(
                        self.labels[self.members[key][0]], self.place(self.members[key][0])
                    )
            self.sketch.joints.append(
                Gears(f"mesh_{keys[0]}_{keys[1]}", bodies[0], bodies[1], (centres[0], centres[1]),
                      (sizes[0] * unit, sizes[1] * unit), belt=belt)
            )  # fmt: skip


def _counts(element: dict[str, Any]) -> bool:
    """Return True if it belongs to the mechanism: no drawing, no measurement."""
    layer = int(_float(element.get("layer"), 16.0)) or 16
    return layer != DRAWING and not _is(element, "measurementelement")


def _is(element: dict[str, Any], word: str) -> bool:
    return str(element.get(word, "")).lower() == "true"


def _float(text: Any, usual: float = 0.0) -> float:
    try:
        value = float(text)
    except (TypeError, ValueError):
        return usual
    return value if math.isfinite(value) else usual


def _labels(elements: dict[str, dict[str, Any]], letter: str) -> dict[str, str]:
    """Return unique names: the author's if given, else a letter and the number."""
    given = [element.get("name", "").strip() for element in elements.values()]
    titles = Titles()
    return {
        key: titles.title_for(name if name and given.count(name) == 1 else f"{letter}{key}")
        for key, name in zip(elements, given, strict=True)
    }
