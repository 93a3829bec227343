"""Modelica documents: classes, identifiers and expressions."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from mbsd.model.laws.formulas import ConstantRate, Harmonic, Polynomial
from mechanisms.stages.export.tree import ROUNDING

# Classes inside the model that PlanarMechanics lacks: each acts between two of its frames.
#
# A frame has x, y, phi and the flows fx, fy, t (counter-clockwise), which its component takes there: a body is pushed
# with the opposite. Of its equations each class has six for these flows, and one for every variable of its own.

_PULLED = """    frame_b.fx = -f*(frame_b.x - frame_a.x)/l;
    frame_b.fy = -f*(frame_b.y - frame_a.y)/l;
    frame_a.fx + frame_b.fx = 0;
    frame_a.fy + frame_b.fy = 0;
    frame_a.t = 0;
    frame_b.t = 0;"""
_TURNED = """    frame_a.fx = 0;
    frame_a.fy = 0;
    frame_b.fx = 0;
    frame_b.fy = 0;
    frame_b.t = -tau;
    frame_a.t = tau;"""

CLASSES = {
    "LineSpring": (
        "Spring and damper between two points; f pushes them apart",
        """    parameter Real k(unit="N/m") "stiffness";
    parameter Real c(unit="N.s/m") "damping";
    parameter Real l0(unit="m") "free length";
    Real l(unit="m") "length";
    Real f(unit="N");""",
        f"""    l = sqrt((frame_b.x - frame_a.x)^2 + (frame_b.y - frame_a.y)^2);
    f = -k*(l - l0) - c*der(l);
{_PULLED}""",
    ),
    "MasslessRod": (
        "Massless rod, or actuator that imposes the distance of two points; f pushes them apart",
        """    input Real l(unit="m") "distance";
    Real f(unit="N");""",
        f"""    (frame_b.x - frame_a.x)^2 + (frame_b.y - frame_a.y)^2 = l^2;
{_PULLED}""",
    ),
    "AngleSpring": (
        "Torsion spring and damper; tau turns the second frame",
        """    parameter Real k(unit="N.m/rad") "stiffness";
    parameter Real c(unit="N.m.s/rad") "damping";
    parameter Real phi0(unit="rad") "free angle";
    Real phi(unit="rad") "angle of the second frame against the first";
    Real tau(unit="N.m");""",
        f"""    phi = frame_b.phi - frame_a.phi;
    tau = -k*(phi - phi0) - c*der(phi);
{_TURNED}""",
    ),
    "ImposedAngle": (
        "Imposes the angle of the second frame against the first; tau turns the second",
        """    input Real phi(unit="rad") "angle";
    Real tau(unit="N.m");""",
        f"""    frame_b.phi - frame_a.phi = phi;
{_TURNED}""",
    ),
    "AppliedTorque": (
        "Torque on the second frame, its opposite on the first",
        """    input Real tau(unit="N.m");""",
        _TURNED,
    ),
    "AppliedForce": (
        "Force on the second frame in a direction of the first, which feels nothing",
        """    parameter Real ux "direction in frame_a";
    parameter Real uy;
    input Real f(unit="N");""",
        """    frame_b.fx = -f*(cos(frame_a.phi)*ux - sin(frame_a.phi)*uy);
    frame_b.fy = -f*(sin(frame_a.phi)*ux + cos(frame_a.phi)*uy);
    frame_b.t = 0;
    frame_a.fx = 0;
    frame_a.fy = 0;
    frame_a.t = 0;""",
    ),
    "ImposedCoordinate": (
        "Imposes how far the second frame lies along a direction of the first; f pushes it there",
        """    parameter Real ux "direction in frame_a";
    parameter Real uy;
    input Real s(unit="m") "distance along it";
    Real ex "direction in the world";
    Real ey;
    Real f(unit="N");""",
        """    ex = cos(frame_a.phi)*ux - sin(frame_a.phi)*uy;
    ey = sin(frame_a.phi)*ux + cos(frame_a.phi)*uy;
    (frame_b.x - frame_a.x)*ex + (frame_b.y - frame_a.y)*ey = s;
    frame_b.fx = -f*ex;
    frame_b.fy = -f*ey;
    frame_b.t = 0;
    frame_a.fx + frame_b.fx = 0;
    frame_a.fy + frame_b.fy = 0;
    frame_a.t = f*((frame_b.x - frame_a.x)*ey - (frame_b.y - frame_a.y)*ex);""",
    ),
    "RackAndPinion": (
        "A pinion about frame_b rolls on a rack along a direction of frame_a; f is the force of the teeth on it",
        """    parameter Real ux "direction in frame_a";
    parameter Real uy;
    parameter Real radius(unit="m") "pitch radius";
    parameter Real c(unit="m") "how it meshes";
    Real ex "direction in the world";
    Real ey;
    Real f(unit="N");""",
        """    ex = cos(frame_a.phi)*ux - sin(frame_a.phi)*uy;
    ey = sin(frame_a.phi)*ux + cos(frame_a.phi)*uy;
    (frame_b.x - frame_a.x)*ex + (frame_b.y - frame_a.y)*ey + radius*(frame_b.phi - frame_a.phi) = c;
    frame_b.fx = -f*ex;
    frame_b.fy = -f*ey;
    frame_b.t = -f*radius;
    frame_a.fx + frame_b.fx = 0;
    frame_a.fy + frame_b.fy = 0;
    frame_a.t = f*((frame_b.x - frame_a.x)*ey - (frame_b.y - frame_a.y)*ex + radius);""",
    ),
    "RollingWheels": (
        "Gears or a belt: both wheels turn against the line of their centres; f acts where they touch",
        """    parameter Real a(unit="m") "pitch radius of the first";
    parameter Real b(unit="m") "of the second, negative where both turn the same way";
    parameter Real c(unit="m") "how they mesh";
    Real gamma(unit="rad") "angle of the line of centres";
    Real d(unit="m") "distance of the centres";
    Real f(unit="N");""",
        """    frame_b.x - frame_a.x = d*cos(gamma);
    frame_b.y - frame_a.y = d*sin(gamma);
    a*(frame_a.phi - gamma) + b*(frame_b.phi - gamma) = c;
    frame_a.t = -f*a;
    frame_b.t = -f*b;
    frame_b.fx = -f*(a + b)*sin(gamma)/d;
    frame_b.fy = f*(a + b)*cos(gamma)/d;
    frame_a.fx + frame_b.fx = 0;
    frame_a.fy + frame_b.fy = 0;""",
    ),
}
"""Blocks by name: the kind, its declarations, its equations."""


def text_of(name: str) -> str:
    """Return the class as it stands inside the model."""
    what, declared, equations = CLASSES[name]
    return (
        f'  model {name} "{what}"\n    extends PlanarMechanics.Interfaces.PartialTwoFrames;\n'
        f"{declared}\n  equation\n{equations}\n  end {name};\n"
    )


# Names in a Modelica model: identifiers, each once.

_LANGUAGE = (
    "algorithm and annotation block break class connect connector constant constrainedby der discrete each else elseif"
    " elsewhen encapsulated end enumeration equation expandable extends external false final flow for function if"
    " import impure in initial inner input loop model not operator or outer output package parameter partial protected"
    " public pure record redeclare replaceable return stream then true type when while within"
)
_USED = "time planarWorld Modelica PlanarMechanics Real Integer Boolean String StateSelect cos sin sqrt"
KEYWORDS = frozenset(f"{_LANGUAGE} {_USED}".split())
"""Keywords of the language (Modelica 3.6, 2.3.3), and names that a model of planar mechanics uses."""


class Identifiers:
    """The names of one model."""

    def __init__(self, model: str) -> None:
        self._taken = {model.lower()}

    def new(self, *words: str) -> str:
        """Return a name that is like these words, joined by ``_``: ``rod 1`` gives ``rod_1``.

        No two differ in the case of letters alone, as files of results on some systems do not.
        """
        wish = name = identifier("_".join(words))
        count = 1
        while name.lower() in self._taken or name in CLASSES:
            count += 1
            name = f"{wish}_{count}"
        self._taken.add(name.lower())
        return name


def identifier(word: str) -> str:
    """Return an identifier like a word."""
    name = re.sub(r"[^0-9A-Za-z_]+", "_", word).strip("_") or "thing"
    return f"n{name}" if name[0].isdigit() else f"{name}_" if name in KEYWORDS else name


def quoted(words: str) -> str:
    """Return a comment of a component."""
    return '"' + words.replace("\\", "\\\\").replace('"', '\\"') + '"'


# Numbers, vectors and laws of time as Modelica has them.


def number(value: float) -> str:
    """Return one number with all its digits."""
    return repr(0.0 if abs(value) < ROUNDING else float(value)).removesuffix(".0")


def vector(*values: float) -> str:
    """Return several in braces."""
    return "{" + ", ".join(number(value) for value in values) + "}"


def signed(value: float) -> str:
    """Return a number to be multiplied or added."""
    return f"({number(value)})" if value < 0 else number(value)


def law(motion: Any) -> str | None:
    """Return a law of time; None for those that have no formula."""
    match motion:
        case ConstantRate():
            return f"{number(motion.start)} + {signed(motion.rate)}*time"
        case Harmonic():
            phase = f"{signed(motion.rate)}*time + {signed(motion.phase)}"
            return f"{number(motion.mean)} + {signed(motion.amplitude)}*sin({phase})"
        case Polynomial():
            first, *others = motion.coefficients
            terms = [f"{signed(value)}*time^{power}" for power, value in enumerate(others, 1)]
            return " + ".join([number(first), *terms])
    return None


# The parts of a Modelica model: components with their modifiers, and connections.


class Document:
    """Collects them; what is given first stands first."""

    def __init__(self, model: str) -> None:
        self.names = Identifiers(model)
        self.lines: list[str] = []
        self.connections: list[str] = []
        self._used: set[str] = set()

    def add(self, kind: str, name: str, modifiers: Mapping[str, str], words: str) -> str:
        """Declare a component of a class of this model, or of PlanarMechanics; returns its name."""
        if kind in CLASSES:
            self._used.add(kind)
        full = kind if kind in CLASSES else f"PlanarMechanics.{kind}"
        given = ", ".join(
            f"{key}{value}" if value.startswith("(") else f"{key}={value}" for key, value in modifiers.items()
        )
        self.lines.append(f"  {full} {name}{f'({given})' if given else ''} {quoted(words)};")
        return name

    def connect(self, first: str, second: str) -> None:
        """Join two frames."""
        self.connections.append(f"  connect({first}, {second});")

    def between(self, kind: str, name: str, ends: tuple[str, str], modifiers: Mapping[str, str], words: str) -> str:
        """Return a component with two frames, connected to two others."""
        made = self.add(kind, self.names.new(name), modifiers, words)
        self.connect(ends[0], f"{made}.frame_a")
        self.connect(f"{made}.frame_b", ends[1])
        return made

    @property
    def classes(self) -> list[str]:
        """The text of each class that is used."""
        return [text_of(name) for name in CLASSES if name in self._used]
