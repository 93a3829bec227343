"""Mechanisms in space of several tests, each from its published numbers."""

from __future__ import annotations

import math

import numpy as np

from mbsd.spatial import Mechanism, constant_rate
from mbsd.spatial.model.rotation import rotation_matrix


def about(axis: list[float] | tuple[float, ...] | np.ndarray, angle: float) -> np.ndarray:
    """Return the rotation (3, 3) about an axis by an angle (rad)."""
    unit = np.array(axis, float) / np.linalg.norm(axis)
    return rotation_matrix([math.cos(angle / 2), *(math.sin(angle / 2) * unit)])


def hooke_joint(bend: float, yoke: float = 0.0, rate: float = 1.0) -> Mechanism:
    """Return two shafts at an angle ``bend`` (rad) in the x, y plane between two bearings; the first is driven.

    ``yoke``: angle of the first axis of the cross from the plane's normal at the start.
    """
    m = Mechanism("Hooke joint")
    out = np.array([math.cos(bend), math.sin(bend), 0.0])
    first = about((1, 0, 0), yoke) @ np.array([0.0, 0.0, 1.0])
    second = np.cross(out, first)
    a = m.shaft("in", (-1, 0, 0), (0, 0, 0), radius=0.01)
    b = m.shaft("out", (0, 0, 0), out, radius=0.01)
    m.revolute("bearing 1", m.ground, a, at=(-1, 0, 0), axis=(1, 0, 0))
    m.universal("cross", a, b, at=(0, 0, 0), first=first, second=second)
    m.revolute("bearing 2", m.ground, b, at=out, axis=out)
    m.drive_turn("motor", "bearing 1", constant_rate(rate))
    return m


def hooke_pair(bend: float, quarter: bool) -> Mechanism:
    """Return two Hooke joints in a Z: input and output parallel; the second cross in phase, or a quarter off."""
    m = Mechanism("Hooke pair")
    middle = np.array([math.cos(bend), math.sin(bend), 0.0])
    normal = np.array([0.0, 0.0, 1.0])
    a = m.shaft("in", (-1, 0, 0), (0, 0, 0), radius=0.01)
    b = m.shaft("middle", (0, 0, 0), middle, radius=0.01)
    c = m.shaft("out", middle, middle + np.array([1.0, 0.0, 0.0]), radius=0.01)
    m.revolute("bearing 1", m.ground, a, at=(-1, 0, 0), axis=(1, 0, 0))
    m.universal("cross 1", a, b, at=(0, 0, 0), first=normal, second=np.cross(middle, normal))
    if quarter:
        m.universal("cross 2", b, c, at=middle, first=normal, second=(0, 1, 0))
    else:
        m.universal("cross 2", b, c, at=middle, first=np.cross(middle, normal), second=normal)
    m.cylindrical("bearing 2", m.ground, c, at=middle, axis=(1, 0, 0))
    m.drive_turn("motor", "bearing 1", constant_rate(1.0))
    return m


def slider_crank(rate: float = -2.0 * math.pi) -> Mechanism:
    """Return the spatial slider-crank of Haug (1989): crank .08 about x at (0, .1, .12), rod .3, slider along x."""
    m = Mechanism("slider-crank")
    bearing, pin, eye = (0, 0.1, 0.12), (0, 0.1, 0.2), (0.2, 0, 0)
    crank = m.body("crank", 0.12, com=(0, 0.1, 0.16), inertia=(1e-4, 1e-4, 1e-5))
    rod = m.rod("rod", pin, eye, mass=0.5, radius=0.01)
    slider = m.body("slider", 2.0, com=eye, inertia=(1e-4, 1e-4, 1e-4))
    along = np.array(eye) - np.array(pin)
    m.revolute("bearing", m.ground, crank, at=bearing, axis=(1, 0, 0))
    m.spherical("ball", crank, rod, at=pin)
    m.universal("cross", slider, rod, at=eye, first=(0, 0, 1), second=np.cross((0, 0, 1), along))
    m.prismatic("rail", m.ground, slider, at=eye, axis=(1, 0, 0))
    m.drive_turn("motor", "bearing", constant_rate(rate))
    m.trace("eye", slider, at=eye)
    return m


def four_link() -> Mechanism:
    """Return the spatial four-link of Haug (1989): crank 2 about x, coupler 12.2, rocker 7.4 about y."""
    m = Mechanism("four-link", gravity=None)
    pin, pivot = np.array([0.0, 0.0, 2.0]), np.array([-4.0, -8.5, 0.0])
    # the rocker's end lies at 7.4 from its pivot, normal to y, and 12.2 from the pin: the intersection that is above
    square = 12.2**2 - 8.5**2
    angle = _intersection(4.0, 2.0, 7.4, square)
    end = pivot + 7.4 * np.array([math.cos(angle), 0.0, math.sin(angle)])
    crank = m.rod("crank", (0, 0, 0), pin, mass=1.0, radius=0.1)
    coupler = m.rod("coupler", pin, end, mass=1.0, radius=0.1)
    rocker = m.rod("rocker", pivot, end, mass=1.0, radius=0.1)
    first = np.array([0.0, 1.0, 0.0])
    m.revolute("bearing 1", m.ground, crank, at=(0, 0, 0), axis=(1, 0, 0))
    m.spherical("ball", crank, coupler, at=pin)
    m.universal("cross", rocker, coupler, at=end, first=first, second=np.cross(first, end - pin))
    m.revolute("bearing 2", m.ground, rocker, at=pivot, axis=(0, -1, 0))
    m.drive_turn("motor", "bearing 1", constant_rate(math.pi))
    m.trace("middle", coupler, at=(pin + end) / 2)
    return m


def _intersection(x: float, z: float, radius: float, square: float) -> float:
    """Return the angle at which (radius cos - x, radius sin - z) has the length whose square is given."""
    size = (radius**2 + x**2 + z**2 - square) / (2 * radius)
    return math.atan2(z, x) + math.acos(size / math.hypot(x, z))


def bennett() -> Mechanism:
    """Return Bennett's four bars of lengths 1 and b = sin(70) / sin(40), twisted by 40 and 70 degrees."""
    alpha, beta = math.radians(40.0), math.radians(70.0)
    a, b = 1.0, math.sin(beta) / math.sin(alpha)
    lengths, twists = (a, b, a, b), (alpha, beta, alpha, beta)
    theta = math.radians(60.0)
    ratio = math.sin((beta + alpha) / 2) / math.sin((beta - alpha) / 2)
    phi = 2 * math.atan(ratio / math.tan(theta / 2))
    # Denavit and Hartenberg: turn about z, along x, twist about x
    place, axes = np.zeros(3), np.eye(3)
    places, directions = [], []
    for length, twist, turn in zip(lengths, twists, (theta, phi, -theta, -phi), strict=True):
        places.append(place)
        directions.append(axes[:, 2])
        axes = axes @ about((0, 0, 1), turn)
        place = place + length * axes[:, 0]
        axes = axes @ about((1, 0, 0), twist)
    assert np.allclose(place, 0.0, atol=1e-12)
    assert np.allclose(axes[:, 2], [0, 0, 1], atol=1e-12)
    m = Mechanism("Bennett")
    links = [m.ground] + [m.body(f"link {k}", 1.0, com=places[k], inertia=(0.1, 0.1, 0.1)) for k in (1, 2, 3)]
    for k in range(4):
        m.revolute(f"hinge {k}", links[k - 1], links[k], at=places[k], axis=directions[k])
    m.drive_turn("motor", "hinge 1", constant_rate(1.0))
    return m


def bricard() -> Mechanism:
    """Return Bricard's six rods of 1 m of the IFToMM benchmark A04, along the edges of a cube."""
    m = Mechanism("Bricard")
    corners = np.array(
        [[0, 0, 0], [1, 0, 0], [1, -1, 0], [1, -1, 1], [0, -1, 1], [0, 0, 1]], float
    )  # hinges along x, y, z in turn, each across both of its rods
    links = [m.ground]
    for k in range(1, 6):
        along = np.abs(corners[k] - corners[k - 1])
        moments = along * 0.02 / 12 + (1 - along) * 1.01 / 12
        links.append(m.body(f"rod {k}", 1.0, com=(corners[k - 1] + corners[k]) / 2, inertia=moments))
    axes = [(0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0)]
    for k in range(6):
        m.revolute(f"hinge {k}", links[k], links[(k + 1) % 6], at=corners[k], axis=axes[k])
    m.trace("P3", links[3], at=corners[3])
    return m


def sarrus(rate: float = 1.0) -> Mechanism:
    """Return Sarrus' two pairs of hinged plates of .2 m that keep a plate level and lead it straight up."""
    m = Mechanism("Sarrus")
    link, start = 0.2, math.radians(10.0)
    top = m.body("top", 2.0, com=(0, 0, 2 * link * math.sin(start)), inertia=(0.1, 0.1, 0.1))
    for name, out, axis in (("x", np.array([1.0, 0, 0]), (0, -1, 0)), ("y", np.array([0, 1.0, 0]), (1, 0, 0))):
        foot = 0.3 * out
        knee = foot + link * (math.cos(start) * out + math.sin(start) * np.array([0, 0, 1.0]))
        head = foot + np.array([0, 0, 2 * link * math.sin(start)])
        lower = m.body(f"lower {name}", 1.0, com=(foot + knee) / 2, inertia=(0.01, 0.01, 0.01))
        upper = m.body(f"upper {name}", 1.0, com=(knee + head) / 2, inertia=(0.01, 0.01, 0.01))
        m.revolute(f"foot {name}", m.ground, lower, at=foot, axis=axis)
        m.revolute(f"knee {name}", lower, upper, at=knee, axis=axis)
        m.revolute(f"head {name}", upper, top, at=head, axis=axis)
    m.drive_turn("motor", "foot x", constant_rate(rate))
    m.trace("plate", top, at=(0, 0, 2 * link * math.sin(start)))
    return m
