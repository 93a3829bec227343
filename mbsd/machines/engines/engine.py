"""A piston engine in a dozen lines: an ordinary mechanism, each body in its place along the shaft.

    m = engine("V8", bore=0.09, stroke=0.08, rod=0.15, piston_mass=0.5, rod_mass=0.6, speed=300.0)
    sol = m.sweep(steps=720)
    sol.orders(sol.shaking().force)

Bodies are ``crank``, ``rod_1``, ``piston_1`` and so on, in the order of the layout's cylinders; joints ``main``,
``pin_k``, ``wrist_k``, ``bore_k``; the driver ``motor``. The shaft turns counter-clockwise about the origin; the z axis
points from its front, where cylinder 1 is, to its rear.

A rod is replaced by masses at its ends, m_r (1 - s) at the pin and m_r s at the piston, s the place of its centre of
mass in parts of its length: with the inertia m_r s (1 - s) l^2 that is no approximation. A counterweight of the share
f takes the moment (N_k is the number of rods on throw k)

    U_k = r [m_throw + N_k (m_r (1 - s) + f (m_p + m_r s))]

from each throw; f = 1/2 cancels all of the first order that turns with the shaft, whatever the layout.

Source: Norton, Design of Machinery, ch. 13 and 14; Maass, Klier 1981, ch. 3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from mbsd.base.arguments import finite_number, not_negative_number, positive_number
from mbsd.base.errors import ModelError
from mbsd.machines.engines.block import Block
from mbsd.machines.engines.firing import firing
from mbsd.machines.engines.layout import Layout
from mbsd.machines.engines.named import named
from mbsd.mechanism import Mechanism
from mbsd.model.body import Body
from mbsd.model.cylinders.cycle import GasCycle
from mbsd.model.forces.gas_cycle import gas_cycle
from mbsd.model.laws.constant_rate import constant_rate

UPRIGHT = 0.5 * math.pi
SPACE = 1.2
"""Spacing of cylinders beside each other, in bores, where none is given."""
SAME = 1e-6
"""Of two angles (rad) or places (spacings)."""


def engine(
    layout: str | Layout,
    *,
    bore: float,
    stroke: float,
    rod: float,
    spacing: float | None = None,
    angle: float | None = None,
    throws: Sequence[float] | None = None,
    split: float | None = None,
    bank_offset: float | None = None,
    piston_mass: float | None = None,
    rod_mass: float | None = None,
    rod_com: float = 0.3,
    throw_mass: float = 0.0,
    counterweight: str | float = "auto",
    flywheel: float = 0.0,
    speed: float | None = None,
    gas: GasCycle | None = None,
    order: Sequence[int] | None = None,
    block: Block | None = None,
    name: str | None = None,
) -> Mechanism:
    """An engine of a layout by name ("V8", "I4", "flat-6", "radial-5", ...) or of a :class:`Layout`.

    ``bore``, ``stroke``, ``rod`` (m, between pin and wrist pin); ``spacing`` of neighbouring throws along the shaft (m,
    1.2 bores by default); ``angle``, ``throws``, ``split`` (degrees): those of :func:`named`; ``bank_offset``: how far
    rods that share a throw are apart (m, a sixth of the spacing by default).

    ``piston_mass`` with rings and wrist pin, ``rod_mass`` (kg), or neither: then the bodies have no mass, and in a
    mechanism's folder get that of their parts. ``rod_com``: place of the rod's centre of mass from the crank pin, in
    parts of its length. ``throw_mass``: of one throw at the radius of the pin (kg). ``counterweight``: "auto" (half of
    the oscillating masses), "rotating" (none of them), "none", or the share of them that each throw's counterweight
    balances beside all that rotates. ``flywheel``: moment of inertia of what turns with the shaft (kg m^2). ``speed``
    (rad/s) drives the shaft; without it nothing does.

    ``gas``: the cycle of each cylinder, such as ``four_stroke(10.0, heat_density=1.5e6)``, in the firing ``order``
    (numbers of the cylinders, by default the one that fires most evenly); forces ``gas_1`` and so on.

    ``block``: with it shaft and bores are in a body ``block`` on mounts ``mount_1`` and so on, at rest at the start; it
    is to be simulated, and ``m.modes()`` has its natural frequencies. Without it they are in ground.

    Raises ModelError for what cannot be: a rod no longer than the throw, cylinders that overlap, throws that do not fit
    the layout, masses that are negative, an order that the throws do not allow.
    """
    of = layout if isinstance(layout, Layout) else named(layout, angle, throws, split)
    if isinstance(layout, Layout) and any(value is not None for value in (angle, throws, split)):
        raise ModelError(f"engine '{of.name}': angle, throws and split are those of its layout; leave them out")
    name = of.name if name is None else name
    given = {"bore": bore, "stroke": stroke, "rod": rod}
    size = {key: positive_number(f"engine '{name}': {key}", value, "m") for key, value in given.items()}
    throw = 0.5 * size["stroke"]
    if size["rod"] <= throw:
        raise ModelError(
            f"engine '{name}': the rod of {1000 * rod:g} mm is no longer than the throw of {1000 * throw:g} mm (half "
            f"the stroke), so the shaft cannot turn; rods have 1.5 to 2 strokes, here {1500 * stroke:g} mm or more"
        )
    apart = SPACE * size["bore"] if spacing is None else spacing
    spacing = positive_number(f"engine '{name}': spacing", apart, "m")
    z = _places(of, name, spacing, bank_offset)
    _refuse_overlaps(of, name, z, size["bore"])
    if (piston_mass is None) != (rod_mass is None):
        raise ModelError(f"engine '{name}': give both piston_mass and rod_mass, or neither")
    end = finite_number(f"engine '{name}': rod_com", rod_com)
    if not 0.0 <= end <= 1.0:
        raise ModelError(f"engine '{name}': rod_com is {end:g}; it must be from 0, at the crank pin, to 1")
    m = Mechanism(name)
    frame = m.ground if block is None else _on_mounts(m, block)
    crank = _crank(m, of, z, throw, _share(name, counterweight), (piston_mass, rod_mass, end, throw_mass), flywheel)
    m.revolute("main", frame.origin, crank.origin)
    poses: dict[str, float] = {}
    for k, (cylinder, place) in enumerate(zip(of.cylinders, z, strict=True), start=1):
        inertia = None if rod_mass is None else rod_mass * end * (1 - end) * rod**2
        con = m.bar(f"rod_{k}", rod, mass=rod_mass, com=(end * rod, 0.0), inertia=inertia, z=place)
        piston = m.body(f"piston_{k}", mass=piston_mass, z=place)
        pin = UPRIGHT + cylinder.throw
        m.revolute(f"pin_{k}", crank.at(throw * math.cos(pin), throw * math.sin(pin), z=place), con.start)
        m.revolute(f"wrist_{k}", con.end, piston.origin)
        axis = UPRIGHT + cylinder.bank
        m.prismatic(f"bore_{k}", frame.at(0.0, 0.0, axis, z=place), piston.origin)
        poses[f"rod_{k}"] = math.degrees(axis - math.asin(throw / rod * math.sin(cylinder.throw - cylinder.bank)))
    m.start_near(**poses)
    if gas is not None:
        _burn(m, frame, of, gas, order, bore=size["bore"], top=throw + rod, stroke=2 * throw)
    elif order is not None:
        raise ModelError(f"engine '{name}': a firing order without gas; give gas=four_stroke(...)")
    if speed is not None:
        law = constant_rate(finite_number(f"engine '{name}': speed", speed))
        if block is None:
            m.drive_angle("motor", crank, law)
        else:
            m.drive_relative_angle("motor", frame, crank, law)
    return m


def _on_mounts(m: Mechanism, block: Block) -> Body:
    """The block as a body, its frame on the shaft's axis."""
    body = m.body("block", block.mass, block.com, block.inertia)
    for k, mount in enumerate(block.mounts, start=1):
        place = m.ground.at(*mount.at), body.at(*mount.at)
        m.bushing(f"mount_{k}", *place, stiffness=(*mount.stiffness, 0.0), damping=(*mount.damping, 0.0))
    m.start_near(block=(0.0, 0.0, 0.0))
    return body


def _burn(
    m: Mechanism,
    frame: Body,
    of: Layout,
    gas: GasCycle,
    order: Sequence[int] | None,
    bore: float,
    top: float,
    stroke: float,
) -> None:
    """Gas in every cylinder; the first of the order fires at its first top dead centre."""
    if not isinstance(gas, GasCycle):
        raise ModelError(f"engine '{m.name}': gas must be four_stroke(...), two_stroke(...) or pressure_table(...)")
    fired = firing(of, order, 2 * gas.turns)
    first = of.cylinders[fired.order[0] - 1]
    for number, since in zip(fired.order, fired.angles, strict=True):
        axis = UPRIGHT + of.cylinders[number - 1].bank
        piston = m.bodies[f"piston_{number}"]
        roof = top + (stroke / (gas.compression - 1.0) if gas.compression else 0.0)
        head = frame.at(roof * math.cos(axis), roof * math.sin(axis), axis + math.pi, z=piston.z)
        at = (first.bank - first.throw) % (2 * math.pi) + float(since)
        gas_cycle(m, f"gas_{number}", head, piston.origin, m.bodies["crank"], gas, bore=bore, fires_at=at)


def _crank(
    m: Mechanism,
    of: Layout,
    z: np.ndarray,
    throw: float,
    share: float | None,
    masses: tuple[float | None, float | None, float, float],
    flywheel: float,
) -> Body:
    """The shaft as one body: its throws, counterweights and flywheel. ``share`` None: without counterweights."""
    piston, rod, end, throw_mass = masses
    spin = not_negative_number(f"engine '{m.name}': flywheel", flywheel)
    heavy = not_negative_number(f"engine '{m.name}': throw_mass", throw_mass)
    if piston is None or rod is None:
        return m.body("crank")
    piston = not_negative_number(f"engine '{m.name}': piston_mass", piston, "kg")
    rod = not_negative_number(f"engine '{m.name}': rod_mass", rod, "kg")
    points: list[tuple[float, float, float, float]] = []
    for direction, place, count in _throws(of, z):
        outward = np.array([math.cos(UPRIGHT + direction), math.sin(UPRIGHT + direction)]) * throw
        opposite = 0.0
        if share is not None:
            opposite = heavy + count * (rod * (1 - end) + share * (piston + rod * end))
        points += [(heavy, *outward, place), (opposite, *-outward, place)]
    return _of_points(m, np.array(points), spin)


def _of_points(m: Mechanism, points: np.ndarray, spin: float) -> Body:
    """The body of point masses (n, 4) of m, x, y, z, and an inertia that turns about the origin beside them."""
    mass, at, z = points[:, 0], points[:, 1:3], points[:, 3]
    total = float(mass.sum())
    if total == 0.0:
        return m.body("crank", mass=0.0, inertia=spin)
    com, middle = mass @ at / total, float(mass @ z) / total
    inertia = spin + float(mass @ ((at - com) ** 2).sum(axis=1))
    products = (mass * (z - middle)) @ (at - com)
    return m.body("crank", total, com.tolist(), inertia, z=middle, products=products.tolist())


def _throws(of: Layout, z: np.ndarray) -> list[tuple[float, float, int]]:
    """Direction (rad), place (m) and number of rods of each throw; pins that are split are throws of their own."""
    found: dict[tuple[int, int], list[int]] = {}
    for k, cylinder in enumerate(of.cylinders):
        turned = round(math.remainder(cylinder.throw, 2 * math.pi) / SAME)
        found.setdefault((turned, round(cylinder.z / SAME)), []).append(k)
    return [(of.cylinders[ks[0]].throw, float(z[ks].mean()), len(ks)) for ks in found.values()]


def _places(of: Layout, name: str, spacing: float, bank_offset: float | None) -> np.ndarray:
    """(N,) places of the cylinders along the shaft (m): rods that share a throw stand side by side."""
    apart = spacing / 6 if bank_offset is None else not_negative_number(f"engine '{name}': bank_offset", bank_offset)
    groups: dict[int, list[int]] = {}
    for k, cylinder in enumerate(of.cylinders):
        groups.setdefault(round(cylinder.z / SAME), []).append(k)
    z = of.z * spacing
    for ks in groups.values():
        z[ks] += apart * (np.arange(len(ks)) - 0.5 * (len(ks) - 1))
    return z


def _refuse_overlaps(of: Layout, name: str, z: np.ndarray, bore: float) -> None:
    """Cylinders of one bank must stand at least a bore apart."""
    for first, one in enumerate(of.cylinders):
        for second in range(first + 1, len(of.cylinders)):
            side = math.remainder(one.bank - of.cylinders[second].bank, 2 * math.pi)
            gap = abs(float(z[first] - z[second]))
            if abs(side) < SAME and gap < bore:
                raise ModelError(
                    f"engine '{name}': cylinders {first + 1} and {second + 1} of one bank are {1000 * gap:.4g} mm "
                    f"apart along the shaft, and the bore is {1000 * bore:g} mm; make spacing larger"
                )


def _share(name: str, counterweight: str | float) -> float | None:
    """Part of the oscillating masses that counterweights balance; None: there are none."""
    words = {"auto": 0.5, "rotating": 0.0, "none": None}
    if isinstance(counterweight, str):
        if counterweight not in words:
            raise ModelError(
                f"engine '{name}': counterweight '{counterweight}'; it is 'auto', 'rotating', 'none' or a number"
            )
        return words[counterweight]
    return not_negative_number(f"engine '{name}': counterweight", counterweight)
