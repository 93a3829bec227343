"""Text of a mechanism.py from a sketch: numbers in Params, links, joints, motors, traced points."""

from __future__ import annotations

import ast
import json
import math

from studio.imports.limits import Names, Titles, printable
from studio.imports.sketch import GROUND, Gears, Link, Load, Motor, Pin, Place, Push, Ram, Sketch, Slide, Weld

NEAR = 1e-9
"""Places closer than this part of the mechanism's size are one."""
ROUNDING = 1e-13
"""Fraction of the numbers behind a place, below which a result counts as zero."""


def mechanism_py(sketch: Sketch, name: str) -> str:
    """Return the whole file; ``name`` is the mechanism's, which the file's own folder has."""
    return _Writer(sketch, name).text()


class _Frame:
    """Axes of a link: from its first point along its second one, or at the angle of the file."""

    def __init__(self, link: Link) -> None:
        places = list(dict.fromkeys(link.points.values()))
        self.origin = places[0] if places else (link.centre or (0.0, 0.0))
        self.end = places[1] if len(places) > 1 and link.angle is None else None
        if self.end is not None:
            self.angle = math.atan2(self.end[1] - self.origin[1], self.end[0] - self.origin[0])
        else:
            self.angle = link.angle or 0.0

    @property
    def length(self) -> float:
        """Distance of the two points; 0 with one."""
        return math.dist(self.origin, self.end) if self.end is not None else 0.0

    def local(self, place: Place) -> Place:
        """Return a place of the world in these axes."""
        x, y = place[0] - self.origin[0], place[1] - self.origin[1]
        c, s = math.cos(self.angle), math.sin(self.angle)
        across, up = c * x + s * y, c * y - s * x
        tiny = ROUNDING * max(math.hypot(x, y), math.hypot(*place), math.hypot(*self.origin))
        return (0.0 if abs(across) < tiny else across, 0.0 if abs(up) < tiny else up)


class _Writer:
    def __init__(self, sketch: Sketch, name: str) -> None:
        self.sketch, self.name = sketch, name
        self.names = Names()
        self.titles, self.points = Titles(), Titles()
        self.frames = {link.name: _Frame(link) for link in sketch.links.values()}
        self.size = max([frame.length for frame in self.frames.values()] + [self._spread()]) or 1.0
        self.params: dict[str, str] = {}
        self.fields = Names()
        self.maths: set[str] = set()

    def _spread(self) -> float:
        places = [place for link in self.sketch.links.values() for place in link.points.values()]
        if not places:
            return 0.0
        return math.dist(tuple(map(min, *places, places[0])), tuple(map(max, *places, places[0])))

    def text(self) -> str:
        bodies = [self._body(link) for link in self.sketch.links.values()]
        joints = [line for joint in self.sketch.joints for line in self._joint(joint)]
        motors = [
            *(self._motor(motor) for motor in self.sketch.motors),
            *(self._push(push) for push in self.sketch.pushes),
            *(self._ram(ram) for ram in self.sketch.rams),
        ]
        loads = [self._load(load) for load in self.sketch.loads]
        traces = [
            f"m.trace({_quoted(self.points.title_for(point))}, {self._marker(link, place)})"
            for point, (link, place) in self.sketch.traces.items()
        ]
        lines = [self._docstring(), "", "from dataclasses import dataclass", *self._imports(motors), "", ""]
        if self.sketch.duration is not None:
            lines += [f"DURATION = {_number(self.sketch.duration)}  # s", "", ""]
        lines += ["@dataclass(frozen=True)", "class Params:", '    """Lengths in metres, speeds in rad/s."""']
        lines += ["", *(f"    {field}: {value}" for field, value in self.params.items())] if self.params else []
        lines += ["", "", "def build(p: Params) -> Mechanism:"]
        gravity = self.sketch.gravity
        lines += [f'    m = Mechanism("{self.name}", gravity={_place(gravity) if gravity else None})']
        body = (*bodies, "", *joints, *([""] if motors or loads else []), *motors, *loads, *traces)
        lines += [f"    {line}" if line else "" for line in body]
        lines += ["", *self._starts(), "    return m", ""]
        return "\n".join(lines)

    def _docstring(self) -> str:
        sketch = self.sketch
        lines = [f'"""{_title(self.name)}, from {_plain(sketch.program)} ({_plain(sketch.name)}). SI units.']
        if sketch.unit:
            lines += ["", f"A unit of the file is taken for {_plain(sketch.unit)}."]
        if sketch.left_out:
            lines += ["", "Left out:", *(f"- {_plain(words)}" for words in sketch.left_out)]
        return lines[0] + '"""' if len(lines) == 1 else "\n".join([*lines, '"""'])

    def _imports(self, motors: list[str]) -> list[str]:
        laws = [law for law in ("constant_rate", "harmonic") if any(law in line for line in motors)]
        maths = sorted(self.maths)
        lines = [f"from numpy import {', '.join(maths)}", ""] if maths else [""]
        return [*lines, f"from mbsd import {', '.join(['Mechanism', *laws])}"]

    def _param(self, word: str, value: str, kind: str) -> str:
        field = self.fields.name_for(word, kind)
        self.params[field] = f"float = {value}"
        return f"p.{field}"

    def _name(self, link: str) -> str:
        return self.names.name_for(link, "link")

    def _body(self, link: Link) -> str:
        frame, name = self.frames[link.name], self._name(link.name)
        words = ""
        if link.mass is not None:
            words += f", mass={_number(link.mass)}"
            if link.centre is not None:
                words += f", com={_place(frame.local(link.centre))}"
            if link.inertia is not None:
                words += f", inertia={_number(link.inertia)}"
        if frame.length > NEAR * self.size:
            return f'{name} = m.bar("{name}", {self._param(link.name, _number(frame.length), "link")}{words})'
        return f'{name} = m.body("{name}"{words})'

    def _marker(self, link: str, place: Place, angle: float | None = None) -> str:
        if link == GROUND:
            turned = _wrapped(angle or 0.0)
            x, y = (0.0 if abs(value) < ROUNDING * self.size else value for value in place)
            words = _place((x, y))[1:-1]
            return f"m.ground.at({words}{f', {_number(turned)}' if turned else ''})"
        frame, name = self.frames[link], self._name(link)
        x, y = frame.local(place)
        turned = None if angle is None else _wrapped(angle - frame.angle)
        near = NEAR * max(self.size, 1e-12)
        if not turned:
            if math.hypot(x, y) < near:
                return f"{name}.start" if frame.length > near else f"{name}.origin"
            if frame.length > near and math.hypot(x - frame.length, y) < near:
                return f"{name}.end"
        return f"{name}.at({_place((x, y))[1:-1]}{f', {_number(turned)}' if turned else ''})"

    def _joint(self, joint: Pin | Slide | Weld | Gears) -> list[str]:
        if isinstance(joint, Gears):
            return [self._gears(joint)]
        title = self._title(joint)
        first, second = (self._marker(link, joint.place) for link in (joint.first, joint.second))
        if isinstance(joint, Pin):
            return [f"m.revolute({title}, {first}, {second})"]
        if isinstance(joint, Weld):
            angle = 0.0 if joint.first == GROUND else self.frames[joint.first].angle
            return [f"m.weld({title}, {first}, {self._marker(joint.second, joint.place, angle)})"]
        guide = self._marker(joint.first, joint.along or joint.place, joint.angle)
        if joint.turns:
            return [f"m.pin_in_slot({title}, {guide}, {second})"]
        return [f"m.prismatic({title}, {guide}, {self._marker(joint.second, joint.place, joint.angle)})"]

    def _gears(self, joint: Gears) -> str:
        markers = ", ".join(self._marker(link, place) for link, place in zip(
            (joint.first, joint.second), joint.places, strict=True))  # fmt: skip
        radii = ", ".join(_number(radius) for radius in joint.radii)
        kind = "belt" if joint.belt else "gear_pair"
        return f"m.{kind}({self._title(joint)}, {markers}, {radii}{', internal=True' if joint.internal else ''})"

    def _motor(self, motor: Motor) -> str:
        start = motor.start
        if start is None:
            start = self._angle(motor.second) - self._angle(motor.first)
        if motor.law:
            law = f"lambda t: {_number(start)} + {motor.law}" if start else f"lambda t: {motor.law}"
            nodes = ast.walk(ast.parse(motor.law, mode="eval"))
            self.maths |= {node.id for node in nodes if isinstance(node, ast.Name)} - {"t"}
        else:
            law = self._constant(motor, start)
        if motor.first == GROUND:
            return f"m.drive_angle({self._title(motor)}, {self._name(motor.second)}, {law})"
        links = f"{self._name(motor.first)}, {self._name(motor.second)}"
        return f"m.drive_relative_angle({self._title(motor)}, {links}, {law})"

    def _constant(self, motor: Motor | Push, start: float) -> str:
        """Return a constant rate as a parameter, from ``start``."""
        alone = len(self.sketch.motors) + len(self.sketch.pushes) == 1
        speed = self._param("speed" if alone else f"speed_{motor.name}", _number(motor.rate), "number")
        return f"constant_rate({speed}{f', {_number(start)}' if abs(start) > 1e-12 else ''})"

    def _push(self, push: Push) -> str:
        along = push.along or push.place
        start = (push.place[0] - along[0]) * math.cos(push.angle) + (push.place[1] - along[1]) * math.sin(push.angle)
        guide, rider = self._marker(push.first, along, push.angle), self._marker(push.second, push.place)
        return f"m.drive_coordinate({self._title(push)}, {guide}, {rider}, {self._constant(push, start)})"

    def _load(self, load: Load) -> str:
        marker, name = self._marker(load.link, load.place), self._name(load.link)
        angle = _number(_wrapped(load.angle - self.frames[load.link].angle if load.turns else load.angle))
        frame = f", frame={name}" if load.turns else ""
        return f"m.force({self._title(load)}, {marker}, {_number(load.force)}, {angle}{frame})"

    def _title(self, thing: Pin | Slide | Weld | Gears | Motor | Push | Ram | Load) -> str:
        """Return a new name of a joint or motor, between quotes."""
        return _quoted(self.titles.title_for(thing.name))

    def _ram(self, ram: Ram) -> str:
        """Return the law of a ram that moves from its shortest to its longest and back.

        One that counts backwards begins at its longest.
        """
        first, second = (
            self._marker(link, place) for link, place in zip((ram.first, ram.second), ram.places, strict=True)
        )
        apart, half = math.dist(*ram.places), math.copysign(ram.stroke / 2, ram.cycles)
        speed = self._param(f"speed_{ram.name}", _number(math.tau * abs(ram.cycles)), "number")
        law = f"harmonic({_number(-half)}, {speed}, pi / 2, {_number(apart + half)})"
        self.maths.add("pi")
        return f"m.drive_distance({self._title(ram)}, {first}, {second}, {law})"

    def _angle(self, link: str) -> float:
        return 0.0 if link == GROUND else self.frames[link].angle

    def _starts(self) -> list[str]:
        """Return the poses of the file as starts: exact up to rounding, so they keep the drawn branch."""
        lines = []
        for link in self.sketch.links.values():
            frame = self.frames[link.name]
            place = (_number(frame.origin[0], 6), _number(frame.origin[1], 6), _number(math.degrees(frame.angle), 6))
            lines.append(f"    m.start_near({self._name(link.name)}=({', '.join(place)}))")
            if link.velocity is not None and not self.sketch.motors:
                speeds = ", ".join(_number(value) for value in link.velocity)
                lines.append(f"    m.start_moving({self._name(link.name)}=({speeds}))")
        return lines


def _number(value: float, digits: int = 12) -> str:
    text = f"{value:.{digits}g}"
    value = float(text)
    return repr(0.0 if value == 0.0 else value) if len(repr(value)) <= len(text) + 2 else text


def _place(place: Place) -> str:
    return f"({_number(place[0])}, {_number(place[1])})"


def _wrapped(angle: float) -> float:
    angle = math.remainder(angle, math.tau)
    return 0.0 if abs(angle) < 1e-12 else angle


def _title(name: str) -> str:
    return name.replace("_", " ").capitalize()


def _quoted(name: str) -> str:
    """Return a printable name between quotes, as ruff writes them."""
    return json.dumps(name, ensure_ascii=False)


def _plain(words: str) -> str:
    """Return the words without characters that would end a docstring or a line."""
    return printable(words.replace("\\", "/").replace('"', "'"))[:300]
