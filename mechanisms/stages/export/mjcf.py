"""MJCF for MuJoCo: a tree of bodies, loops as equalities, springs as tendons, drivers as servos.

The plane of the motion is x y, hinges turn about z; keyframe ``start`` has the speeds of the
first output. Masses are those of the model or its parts; shapes are there to be seen and touch nothing.
"""

from __future__ import annotations

import math
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from mechanisms.stages.export.tree import GROUND, MESHING, Node, Tree, number, numbers, poses_of, tree_of

GAIN = 1e4
"""Gain of the drivers' servos, in N m s (or N s/m) for each kg m^2 (kg) of the mechanism."""
STIFF = {"solref": "0.002 1", "solimp": "0.99 0.999 0.0001"}
"""Constraints that close loops: as stiff as a step of 0.5 ms can do."""
SMALLEST = 1e-9
"""kg, kg m^2: what MuJoCo takes as nothing at all."""


def mjcf(solution: Any) -> tuple[str, list[str]]:
    """Return the file's text, and what it leaves out."""
    m = solution.mechanism
    tree = tree_of(m, poses_of(solution))
    size = max(float(solution.packed.size), 1e-6)
    root = Element("mujoco", model=m.name)
    SubElement(root, "compiler", angle="radian", autolimits="true")
    gx, gy = m.gravity or (0.0, 0.0)
    # Servos are stiff, which only an implicit method stands.
    method = "implicitfast" if m.drivers else "RK4"
    option = {"gravity": numbers(gx, gy, 0.0), "timestep": "0.0005", "integrator": method, "tolerance": "1e-12"}
    SubElement(root, "option", option)
    SubElement(root, "statistic", extent=number(2 * size))
    world = SubElement(root, "worldbody")
    SubElement(world, "light", pos=numbers(0.0, 0.0, 5 * size), dir="0 0 -1", directional="true")
    sites = _Sites()
    joints = _bodies(world, tree, GROUND, size, sites)
    writer = _Writer(root, world, sites, m, size)
    writer.loops(tree)
    writer.springs()
    writer.drivers(tree, joints)
    writer.start(solution, tree)
    sites.place(root)
    indent(root)
    return tostring(root, encoding="unicode") + "\n", [*tree.left_out, *writer.left_out]


class _Sites:
    """Places on bodies that equalities and tendons name."""

    def __init__(self) -> None:
        self.wanted: list[tuple[str, str, Any]] = []

    def site(self, marker: Any) -> str:
        """Return the name of the site of a marker."""
        name = f"{marker.body.name} {len(self.wanted)}"
        self.wanted.append((name, marker.body.name, marker))
        return name

    def place(self, root: Element) -> None:
        """Add them to their bodies."""
        bodies = {body.get("name"): body for body in root.iter("body")}
        bodies[GROUND] = root.find("worldbody")  # type: ignore[assignment]
        for name, body, marker in self.wanted:
            site = Element("site", name=name, pos=numbers(marker.x, marker.y, 0.0), size="1e-4")
            bodies[body].insert(0, site)


def _bodies(element: Element, tree: Tree, parent: str, size: float, sites: _Sites) -> dict[str, list[str]]:
    """Add what is attached to a body; by body, the names of its joints."""
    joints: dict[str, list[str]] = {}
    for node in tree.children(parent):
        body = node.body
        below = SubElement(element, "body", name=body.name, pos=numbers(node.pose.x, node.pose.y, 0.0),
                           euler=numbers(0.0, 0.0, node.pose.angle))  # fmt: skip
        joints[body.name] = _joints(below, node)
        mass, inertia = max(body.mass, SMALLEST), max(body.inertia, SMALLEST)
        SubElement(below, "inertial", pos=numbers(*body.com, 0.0), mass=number(mass),
                   diaginertia=numbers(inertia / 2, inertia / 2 * 1.01, inertia))  # fmt: skip
        _shape(below, node, tree, size)
        joints |= _bodies(below, tree, body.name, size, sites)
    return joints


def _joints(below: Element, node: Node) -> list[str]:
    """Return the joints of a body: one for each freedom against its parent, as they act."""
    name = node.body.name
    hinge = {"type": "hinge", "axis": "0 0 1"}
    if node.joint is None:
        x, y = ({"type": "slide", "axis": _axis(angle - node.pose.angle)} for angle in (0.0, math.pi / 2))
        wanted = [("x", x, None), ("y", y, None), ("turn", hinge, None)]
    else:
        place = numbers(*node.anchor, 0.0)
        slide = {"type": "slide", "axis": _axis(node.guide)}
        match node.joint.kind.name:
            case "weld":
                wanted = []
            case "revolute":
                wanted = [("turn", hinge, place)]
            case "prismatic":
                wanted = [("slide", slide, place)]
            case _:
                both = [("slide", slide, place), ("turn", hinge, place)]
                wanted = both if node.own_is_j else both[::-1]
    for what, attributes, place in wanted:
        SubElement(below, "joint", {"name": f"{name} {what}", **attributes, **({"pos": place} if place else {})})
    return [f"{name} {what}" for what, _, _ in wanted]


def _shape(below: Element, node: Node, tree: Tree, size: float) -> None:
    """A bar from pin to pin, else a ball at the centre of mass."""
    look = {"contype": "0", "conaffinity": "0", "rgba": "0.25 0.45 0.75 1"}
    length = node.body.length
    if length:
        SubElement(
            below,
            "geom",
            {"type": "capsule", "fromto": numbers(0, 0, 0, length, 0, 0), "size": number(size / 60), **look},
        )
    else:
        SubElement(
            below, "geom", {"type": "sphere", "pos": numbers(*node.body.com, 0.0), "size": number(size / 30), **look}
        )


class _Writer:
    def __init__(self, root: Element, world: Element, sites: _Sites, m: Any, size: float) -> None:
        self.root, self.world, self.sites, self.m, self.size = root, world, sites, m, size
        self.left_out: list[str] = []

    def _section(self, name: str) -> Element:
        section = self.root.find(name)
        return SubElement(self.root, name) if section is None else section

    def loops(self, tree: Tree) -> None:
        for joint in tree.loops:
            if joint.kind.name in MESHING:
                self._mesh(joint, tree)
                continue
            first, second = self.sites.site(joint.i), self.sites.site(joint.j)
            if joint.kind.name == "distance":
                self._tendon(joint.name, first, second, {})
                SubElement(self._section("equality"), "tendon", {"tendon1": joint.name, **STIFF})
            else:
                kind = "connect" if joint.kind.name == "revolute" else "weld"
                SubElement(
                    self._section("equality"), kind, {"name": joint.name, "site1": first, "site2": second, **STIFF}
                )

    def _mesh(self, joint: Any, tree: Tree) -> None:
        """Two wheels on one carrier: the turn of the second is a multiple of that of the first."""
        nodes = {node.body.name: node for node in tree.nodes}
        pair = [nodes.get(name) for name in joint.bodies]
        turning = [
            node for node in pair if node is not None and node.joint is not None and node.joint.kind.name == "revolute"
        ]
        p = joint.params
        if len(turning) < 2 or turning[0].parent != turning[1].parent or not p.get("radius_i") or not p.get("radius_j"):
            self.left_out.append(f"joint '{joint.name}' ({joint.kind.name})")
            return
        same = p.get("internal", False) if joint.kind.name == "gear_pair" else not p.get("crossed", False)
        ratio = p["radius_i"] / p["radius_j"] * (1.0 if same else -1.0)
        first, second = (f"{node.body.name} turn" for node in turning)
        mesh = {"name": joint.name, "joint1": second, "joint2": first, "polycoef": f"0 {number(ratio)} 0 0 0"}
        SubElement(self._section("equality"), "joint", mesh | STIFF)

    def springs(self) -> None:
        for name, force in self.m.forces.items():
            if force.kind.name == "spring" and not force.laws:
                p = force.params
                amounts = {"stiffness": number(p.get("stiffness", 0.0)), "damping": number(p.get("damping", 0.0)),
                           "springlength": number(p.get("free_length", 0.0))}  # fmt: skip
                self._tendon(name, self.sites.site(force.i), self.sites.site(force.j), amounts)
            else:
                self.left_out.append(f"force '{name}' ({force.kind.name})")

    def _tendon(self, name: str, first: str, second: str, more: dict[str, str]) -> None:
        tendon = SubElement(
            self._section("tendon"), "spatial", {"name": name, "width": number(self.size / 200), **more}
        )
        for site in (first, second):
            SubElement(tendon, "site", site=site)

    def drivers(self, tree: Tree, joints: dict[str, list[str]]) -> None:
        parents = {node.body.name: node for node in tree.nodes}
        for name, driver in self.m.drivers.items():
            first, second = driver.i.body.name, driver.j.body.name
            node = parents.get(second)
            rate = getattr(driver.motion, "rate", None) if type(driver.motion).__name__ == "ConstantRate" else None
            if node is None or rate is None or node.parent != first or len(joints.get(second, ())) != 1:
                self.left_out.append(f"driver '{name}' ({driver.kind.name})")
                continue
            weight = sum(body.inertia + body.mass * self.size**2 for body in self.m.bodies.values())
            sense = 1.0 if driver.kind.angular or node.own_is_j else -1.0
            SubElement(self._section("actuator"), "velocity", name=name, joint=joints[second][0],
                       kv=number(GAIN * max(weight, 1e-6)), gear=number(sense))  # fmt: skip

    def start(self, solution: Any, tree: Tree) -> None:
        """The speeds of the first output as a keyframe, with the rates of the drivers."""
        speeds: list[float] = []
        for node in _in_order(tree, GROUND):
            speeds += _speeds(solution, node)
        actuators = (
            [actuator.get("name") for actuator in self._section("actuator")]
            if self.root.find("actuator") is not None
            else []
        )
        key: dict[str, str] = {"name": "start", "qvel": numbers(*speeds)}
        if actuators:
            key["ctrl"] = numbers(*(float(self.m.drivers[name].motion.rate) for name in actuators))
        if speeds:
            SubElement(self._section("keyframe"), "key", key)


def _in_order(tree: Tree, parent: str) -> list[Node]:
    """Return bodies in the order of the file."""
    return [node for child in tree.children(parent) for node in (child, *_in_order(tree, child.body.name))]


def _speeds(solution: Any, node: Node) -> list[float]:
    """Return rates of a body's joints at the first output."""
    view = solution.body(node.body.name)
    if node.joint is None:
        return [float(view.vx[0]), float(view.vy[0]), float(view.omega[0])]
    above = None if node.parent == GROUND else solution.body(node.parent)
    turn = float(view.omega[0]) - (float(above.omega[0]) if above is not None else 0.0)
    match node.joint.kind.name:
        case "weld":
            return []
        case "revolute":
            return [turn]
    slide = _sliding(solution, node)
    if node.joint.kind.name == "prismatic":
        return [slide]
    return [slide, turn] if node.own_is_j else [turn, slide]


def _sliding(solution: Any, node: Node) -> float:
    """Return how fast the body moves along the guide, seen from its parent."""
    joint = node.joint
    assert joint is not None
    first, second = solution.place(joint.i), solution.place(joint.j)
    own, other = (second, first) if node.own_is_j else (first, second)
    angle, omega = float(first.theta[0]), float(first.omega[0])
    dx, dy = float(second.x[0] - first.x[0]), float(second.y[0] - first.y[0])
    vx, vy = float(own.vx[0] - other.vx[0]), float(own.vy[0] - other.vy[0])
    rate = vx * math.cos(angle) + vy * math.sin(angle)
    if node.own_is_j:  # without what the guide's own turning gives at that place
        return rate + omega * (dy * math.cos(angle) - dx * math.sin(angle))
    return rate + omega * (dx * math.sin(angle) - dy * math.cos(angle))


def _axis(angle: float) -> str:
    return numbers(math.cos(angle), math.sin(angle), 0.0)
