"""A Modelica file read back, and its equations at a moment of a motion.

The text is parsed: classes, components with modifiers, connections. Equations of the classes are taken from the text,
those of PlanarMechanics 1.6.0 are written down here. At a moment all frames are where the bodies have them; then
equations of places must hold, and what is left is linear in forces: as many equations of full rank as unknowns, solved
by all bodies' accelerations if the model is right.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Array = np.ndarray
FLOWS = ("fx", "fy", "t")
LIBRARY = {"Body", "Fixed", "FixedTranslation", "FixedRotation", "Revolute", "Prismatic"}
UNKNOWN_UNITS = ("N", "N.m")


@dataclass
class Component:
    """One declaration."""

    kind: str
    name: str
    modifiers: dict[str, str]
    words: str

    def number(self, name: str) -> Any:
        """A modifier that is a number or a vector."""
        return _value(self.modifiers[name])


@dataclass
class ModelicaFile:
    """The text, parsed; a name that is used and not declared, or declared twice, fails."""

    text: str
    components: dict[str, Component] = field(default_factory=dict)
    connections: list[tuple[str, str]] = field(default_factory=list)
    classes: dict[str, tuple[dict[str, str], list[str]]] = field(default_factory=dict)
    """By name: declared variables with their units, equations."""

    def __post_init__(self) -> None:
        head = re.search(r'^model (\w+) "', self.text, re.MULTILINE)
        assert head is not None
        assert self.text.rstrip().endswith(f"end {head[1]};")
        self.name = head[1]
        for name, body in re.findall(r"^  model (\w+) \".*?\n(.*?)^  end \1;", self.text, re.MULTILINE | re.DOTALL):
            declared, _, equations = body.partition("  equation\n")
            units = dict(re.findall(r'(?:Real|input Real) (\w+)(?:\(unit="([^"]*)"\))?', declared))
            self.classes[name] = units, [line.strip().rstrip(";") for line in equations.strip().split("\n")]
        for kind, name, given, words in re.findall(
            r"^  (?:inner )?([\w.]+) (\w+)(\(.*\))? \"([^\"]*)\";$", self.text, re.MULTILINE
        ):
            assert name not in self.components
            assert kind in self.classes or kind.startswith("PlanarMechanics.")
            self.components[name] = Component(kind.rpartition(".")[2], name, modifiers_of(given[1:-1]), words)
        self.connections = re.findall(r"^  connect\(([\w.]+), ([\w.]+)\);$", self.text, re.MULTILINE)
        for end in (end for pair in self.connections for end in pair):
            assert end in self.frames, end

    @property
    def frames(self) -> list[str]:
        """All frames."""
        ends = {"Body": ("frame_a",), "Fixed": ("frame",), "PlanarWorld": ()}
        return [f"{c.name}.{end}" for c in self.components.values() for end in ends.get(c.kind, ("frame_a", "frame_b"))]


def modifiers_of(text: str) -> dict[str, str]:
    """By name: values of ``a=1, r={1, 2}, phi(start=3)``."""
    out: dict[str, str] = {}
    depth, start = 0, 0
    for k, sign in enumerate(f"{text},"):
        depth += (sign in "({") - (sign in ")}")
        if sign == "," and depth == 0 and text[start:k].strip():
            part = text[start:k].strip()
            name = re.match(r"\w+", part)
            assert name is not None
            out[name[0]] = part[len(name[0]) :].lstrip("=")
            start = k + 1
    return out


def _value(text: str) -> Any:
    return np.array(eval(text.replace("{", "[").replace("}", "]")), float)


class Moment:
    """The equations of a file where bodies have these poses (x, y, theta of their frames), rates and accelerations."""

    def __init__(self, file: ModelicaFile, state: dict[str, Array], time: float) -> None:
        """``state`` (3, 3) by body: rows are poses, rates, accelerations of the frame of its component."""
        self.file, self.time = file, time
        self.places = self._placed({name: rows[0] for name, rows in state.items()})
        step = 1e-6
        self.ahead, self.back = (
            self._placed({name: rows[0] + sign * step * rows[1] for name, rows in state.items()}) for sign in (1, -1)
        )
        self.step, self.state = step, state

    def _placed(self, bodies: dict[str, Array]) -> dict[str, Array]:
        """Every frame's pose: from the bodies along connections and rigid parts; two ways must agree."""
        places = {f"{name}.frame_a": pose for name, pose in bodies.items()}
        for c in self.file.components.values():
            if c.kind == "Fixed":
                places[f"{c.name}.frame"] = np.array([*c.number("r"), 0.0])
        before = -1
        while len(places) > before:
            before = len(places)
            for a, b in self.file.connections:
                for here, there in ((a, b), (b, a)):
                    if here in places:
                        near = places.setdefault(there, places[here])
                        assert near == pytest_approx(places[here]), (here, there)
            for c in self.file.components.values():
                if c.kind in ("FixedTranslation", "FixedRotation"):
                    self._rigid(c, places)
            self._slotted(places)
        assert set(places) == set(self.file.frames)
        return places

    def _slotted(self, places: dict[str, Array]) -> None:
        """Add the place of a slider between a guide and a pin: that of the pin, turned as the guide."""
        pairs = ((a.partition(".")[0], b.partition(".")[0]) for a, b in self.file.connections if a.endswith("frame_b"))
        for guide, pin in pairs:
            kinds = [self.file.components[name].kind for name in (guide, pin)]
            pin_b, guide_a = f"{pin}.frame_b", f"{guide}.frame_a"
            if kinds == ["Prismatic", "Revolute"] and pin_b in places and guide_a in places:
                between = np.array([*places[pin_b][:2], places[guide_a][2]])
                places |= {f"{guide}.frame_b": between, f"{pin}.frame_a": between}

    @staticmethod
    def _rigid(c: Component, places: dict[str, Array]) -> None:
        a, b = f"{c.name}.frame_a", f"{c.name}.frame_b"
        for here, there, sign in ((a, b, 1), (b, a, -1)):
            if here not in places:
                continue
            x, y, phi = places[here]
            moved = np.array([x, y, phi + sign * float(c.number("alpha"))]) if c.kind == "FixedRotation" else None
            if moved is None:
                (u, v), cos, sin = c.number("r"), math.cos(phi), math.sin(phi)
                moved = np.array([x + sign * (cos * u - sin * v), y + sign * (sin * u + cos * v), phi])
            assert places.setdefault(there, moved) == pytest_approx(moved), (here, there)

    def forces(self) -> tuple[float, int, int, int]:
        """Return the balance of forces: largest residual, numbers of equations and unknowns, rank."""
        unknowns = [f"{frame}.{flow}" for frame in self.file.frames for flow in FLOWS]
        for c in self.file.components.values():
            if c.kind in self.file.classes:
                units = self.file.classes[c.kind][0]
                unknowns += [f"{c.name}.{v}" for v, unit in units.items()
                             if unit in UNKNOWN_UNITS and v not in c.modifiers]  # fmt: skip
        columns = np.stack([self._balance(dict(zip(unknowns, row, strict=True)))
                            for row in np.vstack([np.zeros(len(unknowns)), np.eye(len(unknowns))])])  # fmt: skip
        matrix, right = (columns[1:] - columns[0]).T, -columns[0]
        scaled = matrix / np.maximum(np.abs(matrix).max(axis=1, initial=0.0), 1e-12)[:, None]
        solved = np.linalg.lstsq(matrix, right, rcond=None)[0]
        miss = float(np.abs(matrix @ solved - right).max()) / max(1.0, float(np.abs(right).max()))
        return miss, len(right), len(unknowns), int(np.linalg.matrix_rank(scaled, tol=1e-9))

    def _balance(self, u: dict[str, float]) -> Array:
        """Residuals of all equations that have forces."""
        out = [sum(u[f"{frame}.{flow}"] for frame in group) for group in self._nets() for flow in FLOWS]
        for c in self.file.components.values():
            if c.kind in LIBRARY:
                out += getattr(self, f"_{c.kind.lower()}")(c, u)
            elif c.kind in self.file.classes:
                out += self._written(c, u)
        return np.array(out)

    def _nets(self) -> list[set[str]]:
        nets = [{frame} for frame in self.file.frames]
        for a, b in self.file.connections:
            first, second = (next(net for net in nets if end in net) for end in (a, b))
            if first is not second:
                first |= second
                nets.remove(second)
        return nets

    def _ends(self, c: Component, u: dict[str, float]) -> tuple[Array, Array, Array]:
        """Flows at both ends, and the way from the first to the second."""
        a, b = (np.array([u[f"{c.name}.{end}.{flow}"] for flow in FLOWS]) for end in ("frame_a", "frame_b"))
        return a, b, self.places[f"{c.name}.frame_b"] - self.places[f"{c.name}.frame_a"]

    def _rigid_balance(self, c: Component, u: dict[str, float]) -> list[float]:
        a, b, way = self._ends(c, u)
        return [a[0] + b[0], a[1] + b[1], a[2] + b[2] + way[0] * b[1] - way[1] * b[0]]

    _fixedtranslation = _fixedrotation = _rigid_balance

    def _fixed(self, c: Component, u: dict[str, float]) -> list[float]:
        return []

    def _body(self, c: Component, u: dict[str, float]) -> list[float]:
        gravity = self.file.components["planarWorld"].number("constantGravity")
        m, inertia, (ax, ay, alpha) = c.number("m"), c.number("I"), self.state[c.name][2]
        fx, fy, t = (u[f"{c.name}.frame_a.{flow}"] for flow in FLOWS)
        return [fx + m * (gravity[0] - ax), fy + m * (gravity[1] - ay), t - inertia * alpha]

    def _revolute(self, c: Component, u: dict[str, float]) -> list[float]:
        _, b, way = self._ends(c, u)
        assert way[:2] == pytest_approx(np.zeros(2)), c.name
        return [*self._rigid_balance(c, u), b[2]]

    def _prismatic(self, c: Component, u: dict[str, float]) -> list[float]:
        a, _, way = self._ends(c, u)
        phi = self.places[f"{c.name}.frame_a"][2]
        x, y = c.number("r")
        e = np.array([math.cos(phi) * x - math.sin(phi) * y, math.sin(phi) * x + math.cos(phi) * y])
        assert [way[0] * e[1] - way[1] * e[0], way[2]] == pytest_approx(np.zeros(2)), c.name
        return [*self._rigid_balance(c, u), float(a[:2] @ e)]

    def _written(self, c: Component, u: dict[str, float]) -> list[float]:
        """Residuals of the equations in the text: those of places must hold, those with flows are returned."""
        units, equations = self.file.classes[c.kind]
        known = {
            name: self._said(c, name) for name in units if name in c.modifiers and "start" not in c.modifiers[name]
        }
        out = []
        for equation in equations:
            names = self._names(c, u, self.places) | known
            left, _, right = (side.strip() for side in equation.partition(" = "))
            if left in units and units[left] not in UNKNOWN_UNITS:
                ways = (self._names(c, u, places) | known for places in (self.ahead, self.back))
                known[f"der_{left}"] = np.subtract(*(_eval(right, way) for way in ways)) / (2 * self.step)
                known[left] = _eval(right, names)
                continue
            if "gamma" in units and "gamma" not in known:
                dx, dy, _ = self.places[f"{c.name}.frame_b"] - self.places[f"{c.name}.frame_a"]
                start = float(re.findall(r"start=([^),]+)", c.modifiers["gamma"])[0])
                known |= {
                    "d": math.hypot(dx, dy),
                    "gamma": start + math.remainder(math.atan2(dy, dx) - start, math.tau),
                }
                names |= known
            value = _eval(left, names) - _eval(right, names)
            if re.search(r"frame_[ab]\.(fx|fy|t)\b|\b(f|tau)\b", equation):
                out.append(value)
            else:
                assert value == pytest_approx(0.0), (c.name, equation)
        return out

    def _said(self, c: Component, name: str) -> float:
        return float(eval(c.modifiers[name].replace("^", "**"), {"time": self.time, "sin": math.sin}))

    def _names(self, c: Component, u: dict[str, float], places: dict[str, Array]) -> dict[str, float]:
        names = {
            key.rpartition(".")[2]: value
            for key, value in u.items()
            if key.count(".") == 1 and key.startswith(f"{c.name}.")
        }
        for end in ("frame_a", "frame_b"):
            names |= dict(zip((f"{end}_x", f"{end}_y", f"{end}_phi"), places[f"{c.name}.{end}"], strict=True))
            names |= {f"{end}_{flow}": u[f"{c.name}.{end}.{flow}"] for flow in FLOWS}
        return names


def _eval(text: str, names: dict[str, float]) -> float:
    plain = re.sub(r"der\((\w+)\)", r"der_\1", re.sub(r"(frame_[ab])\.", r"\1_", text)).replace("^", "**")
    return float(eval(plain, {"cos": math.cos, "sin": math.sin, "sqrt": math.sqrt} | names))


def pytest_approx(value: Any) -> Any:
    """Equal to 1e-9."""
    import pytest

    return pytest.approx(value, abs=1e-9)
