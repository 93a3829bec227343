"""The motion file data.json: bodies with their shapes, poses, forces, and vibrations."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from mechanisms.stages.solve.masses import Source
from mechanisms.stages.solve.skeleton_file import body_colours
from shared import contract
from shared.contract import Shape
from shared.contract.loads import Look

if TYPE_CHECKING:
    from mbsd import Joint, Solution
    from mbsd.model.force import Force
    from mbsd.results.force_view import ForceView
    from mbsd.results.views import Wrench


# How joints, forces and contacts look beyond their signs: markers, wheels, curves, as data.json has them.

POINTS = 240
"""Points of an outline, about and at most."""


def shape_of(element: Joint | Force) -> Shape:
    """Return the shape between the two markers of a joint, force or contact."""
    from mbsd.model.cables import seen_span
    from mbsd.model.force import Force as AnyForce
    from mbsd.model.force import ForceKind
    from mbsd.model.joint import Joint as AnyJoint
    from mbsd.model.mechanism import Model
    from mbsd.model.teeth import with_radii

    if isinstance(element, AnyJoint) and "span" in element.kind.constraints:
        element = seen_span(cast(Model, element.i.body.mechanism), element)
    params = dict(with_radii(element.params))
    profile, laws = params.get("profile"), getattr(element, "laws", {})
    outline: list[tuple[float, float]] = []
    if profile is not None:
        outline, sizes = _cam(profile)
        params |= sizes
    elif "points" in params:
        outline = _curve(params["points"], params["closed"])
    elif "profile" in laws:
        outline = _profile(laws["profile"])
    if isinstance(element, AnyForce) and element.kind.journal is not None:  # the bearing lies around the journal
        params |= {"radius_i": params["radius"], "radius_j": element.kind.journal(element)[0], "inside": True}
    geneva = "slots" in params
    teeth = params.get("teeth")
    of_pin = isinstance(element.kind, ForceKind) and element.kind.of_reactions
    return Shape(
        bodies=element.bodies,
        markers=((element.i.x, element.i.y, element.i.angle), (element.j.x, element.j.y, element.j.angle)),
        radius_first=_positive(params.get("radius_i")),
        radius_second=None if geneva or of_pin else _positive(params.get("radius_j", params.get("radius"))),
        teeth=[] if teeth is None else [teeth] if isinstance(teeth, int) else list(teeth),
        ring=bool(params.get("internal") or params.get("inside")),
        crossed=bool(params.get("crossed")),
        clockwise=[params["clockwise_i"], params["clockwise_j"]] if "clockwise_i" in params else [],
        slots=params.get("slots"),
        pin_radius=_positive(params.get("radius")) if geneva or of_pin else None,
        length=None if of_pin else params.get("length", params.get("free_length")),
        outline=outline,
        outline_closed=profile is not None or bool(params.get("closed")),
    )


def _positive(value: float | None) -> float | None:
    return value if value else None


def _cam(data: Any) -> tuple[list[tuple[float, float]], dict[str, float]]:
    """Return the disc as it is cut, and the radius of its roller if it has one."""
    from mbsd.cams import cam_from

    profile = cam_from(data)
    kept = profile.outline[:: max(1, len(profile.outline) // POINTS)]
    return _pairs(kept), {} if profile.flat else {"radius": profile.sizes["roller_radius"]}


def _curve(points: Any, closed: bool) -> list[tuple[float, float]]:
    """Return the smooth curve through the points of a joint or terrain."""
    from mbsd.model.plane_curves import curve_pieces

    breaks, coefficients = curve_pieces(np.array(points, float), closed)  # (pieces, 2, 6) by rising powers
    each = max(1, round(POINTS / len(coefficients)))
    width = np.diff(breaks)
    ahead = width[:, None] * np.arange(each) / each
    path = np.einsum("spk,sck->spc", ahead[..., None] ** np.arange(6), coefficients).reshape(-1, 2)
    end = np.einsum("k,ck->c", width[-1] ** np.arange(6), coefficients[-1])
    return _pairs(path if closed else np.vstack([path, end]))


def _profile(curve: Any) -> list[tuple[float, float]]:
    """Return the profile y(x) of a surface with give."""
    x = np.linspace(float(curve.x[0]), float(curve.x[-1]), POINTS + 1)
    return _pairs(np.stack([x, curve(x)[:, 0]], axis=1))


def _pairs(path: Any) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in path]


# Vibration of the frame, as data.json has it: only of motions that repeat with a crank.

HIGHEST = 8
"""The highest order."""
WHOLE = 1e-6
"""Turns: what misses a whole number by less is one."""


def vibration(solution: Solution) -> contract.Vibration | None:
    """Return the inertia forces.

    None where nothing has mass, or the motion does not repeat after whole turns of something on ground.
    """
    m = solution.mechanism
    if solution.period is None or not any(body.mass > 0 for body in m.bodies.values()):
        return None
    crank = _crank(solution)
    if crank is None:
        return None
    turned = abs(float(np.ptp(solution.body(crank).theta[[0, -1]]))) / math.tau
    turns = round(turned)
    if abs(turned - turns) > WHOLE:
        return None
    axis = _axis(solution, crank)
    about = solution.shaking(axis, z=solution.planes.middle if solution.planes else 0.0)
    quantities: dict[str, tuple[str, np.ndarray]] = {
        "shaking force": ("N", about.force),
        "shaking moment": ("N m", about.moment),
    }
    if solution.planes is not None and not solution.planes.is_one:
        quantities["shaking couple"] = ("N m", about.couple)
    for name, driver in m.drivers.items():
        quantities[name] = ("N m" if driver.kind.angular else "N", solution.driver(name).effort)
    for name, joint in m.joints.items():
        if "ground" in joint.bodies and name not in quantities:
            quantities[name] = ("N", solution.joint(name).reaction)
    harmonics = {name: _harmonics(solution, crank, turns, *quantity) for name, quantity in quantities.items()}
    centre = solution.centre_of_mass()
    return contract.Vibration(
        about=axis,
        fx=about.fx.tolist(),
        fy=about.fy.tolist(),
        moment=about.moment.tolist(),
        x=centre.x.tolist(),
        y=centre.y.tolist(),
        crank=crank,
        turns=turns,
        order=[k / turns for k in range(1, HIGHEST * turns + 1)],
        harmonics={name: orders for name, orders in harmonics.items() if orders is not None},
    )


def _crank(solution: Solution) -> str | None:
    """Return the body by whose angle orders count.

    None if nothing on a pin of ground makes whole turns one way.
    """
    from mbsd import ModelError

    try:
        return solution.orders(solution.t).crank
    except ModelError:
        return None


def _axis(solution: Solution, crank: str) -> tuple[float, float]:
    for joint in solution.mechanism.joints.values():
        if joint.kind.pair == "pin" and set(joint.bodies) == {"ground", crank}:
            end = joint.i if joint.i.body.name == "ground" else joint.j
            return end.x, end.y
    return 0.0, 0.0


def _harmonics(solution: Solution, crank: str, turns: int, unit: str, values: np.ndarray) -> contract.Harmonics | None:
    """Return vibrations; None if there are too few rows for the orders."""
    orders = solution.orders(values, crank, turns)
    count = HIGHEST * turns
    if len(orders.order) < count:
        return None
    amplitude, phase = (series[:count].reshape(count, -1).T for series in (orders.amplitude, orders.phase))
    return contract.Harmonics(
        unit=unit,
        mean=np.atleast_1d(orders.mean).tolist(),
        amplitude=amplitude.tolist(),
        phase=phase.tolist(),
        forward=np.abs(orders.forward[:count]).tolist(),
        backward=np.abs(orders.backward[:count]).tolist(),
    )


# A solution as data.json has it: plain lists, author's frames.

FRAME = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")
PLACED = ("x", "y", "fx", "fy", "torque")


def to_motion(
    solution: Solution,
    parts: contract.Parts | None,
    inputs: str,
    packages: dict[str, str],
    sources: Mapping[str, Source] | None = None,
) -> contract.Motion:
    """Return the solution as the contract has it; bodies without solids have no height.

    Times at which efforts do not exist are left out, and its notes say so.
    ``sources`` says where the mass of each body is from; if it is not given, from the parts.
    """
    import mbsd
    from mbsd.results.rows import release_times

    notes = list(solution.notes)
    solution = solution.only(solution.is_defined) if notes else solution
    released = release_times(solution)
    m, energy = solution.mechanism, solution.energy
    return contract.Motion(
        mechanism=m.name,
        provenance=contract.Provenance(inputs=inputs, versions=packages | {"mbsd": mbsd.__version__}),
        gravity=(float(m.gravity[0]), float(m.gravity[1])) if m.gravity else (0.0, 0.0),
        analysis="sweep" if solution.work is None else "simulation",
        period=solution.period,
        time=solution.t.tolist(),
        bodies=_bodies(solution, parts, sources),
        joints={name: _joint(solution, joint, released.get(name)) for name, joint in m.joints.items()},
        drivers={name: _driver(solution, driver) for name, driver in m.drivers.items()},
        points={
            name: contract.PointMotion(
                body=marker.body.name, **_lists(solution.point(name), ("x", "y", "vx", "vy", "ax", "ay"))
            )
            for name, marker in m.traces.items()
        },
        forces={name: _force(solution, view) for name, view in solution.forces.items()},
        contacts={name: _contact(solution, name, row) for name, row in solution.packed.contact_gaps().items()},
        energy=contract.Energy(
            kinetic=energy.kinetic.tolist(),
            potential=energy.potential.tolist(),
            work=_list(solution.work),
            audit=_list(solution.audit),
        ),
        couple=_couple(solution),
        vibration=vibration(solution),
        events=[
            contract.EventMark(
                time=event.time, name=event.name, what=event.what, energy=event.energy, impulse=event.impulse
            )
            for event in solution.events
        ],
        start_changes=list(solution.changes),
        notes=notes,
        diagnostics=_diagnostics(solution),
    )


def _bodies(
    solution: Solution, parts: contract.Parts | None, sources: Mapping[str, Source] | None
) -> dict[str, contract.BodyMotion]:
    from mbsd.drawing.look import on_dark

    inks = body_colours(solution.mechanism, parts)
    return {
        name: contract.BodyMotion(
            **_lists(solution.body(name), FRAME),
            z=parts.bodies[name].z if parts and name in parts.bodies else None,
            mass=body.mass,
            mass_from=sources[name] if sources else "parts",
            com=body.com,
            inertia=body.inertia,
            colour=inks[name],
            colour_on_dark=on_dark(inks[name]),
        )
        for name, body in solution.mechanism.bodies.items()
        if name != "ground"
    }


def _joint(solution: Solution, joint: Joint, released: float | None) -> contract.JointMotion:
    view = solution.joint(joint.name)
    return contract.JointMotion(
        kind=joint.kind.name,
        bodies=joint.bodies,
        **_lists(view, PLACED),
        pair=joint.kind.pair,  # pyright: ignore[reportArgumentType]  (the contract lists them)
        look=joint.kind.look,  # pyright: ignore[reportArgumentType]
        acts=_acts(view.acts) if joint.kind.touching else None,
        shape=shape_of(joint),
        released=released,
    )


def _driver(solution: Solution, driver: Joint) -> contract.DriverMotion:
    return contract.DriverMotion(
        kind=driver.kind.name.removeprefix("drive_"),
        bodies=driver.bodies,
        unit="rad" if driver.kind.angular else "m",
        effort_unit="N m" if driver.kind.angular else "N",
        look=driver.kind.look,  # pyright: ignore[reportArgumentType]
        actions=_actions(solution, driver),
        shape=shape_of(driver),
        **_lists(solution.driver(driver.name), ("value", "effort", "power")),
    )


def _diagnostics(solution: Solution) -> contract.Diagnostics:
    stats = solution.stats
    return contract.Diagnostics(
        position_residual=stats.position_residual,
        velocity_residual=stats.velocity_residual,
        acceleration_residual=stats.acceleration_residual,
        power_residual=stats.power_residual,
        dof=solution.mobility.dof,
        redundant=list(solution.mobility.redundant),
        singularity_margin=solution.singularity_margin.tolist(),
    )


def _couple(solution: Solution) -> contract.Couple | None:
    """Return moments about the middle of the bodies along the normal of the plane."""
    assert solution.planes is not None
    if solution.planes.is_one:
        return None
    middle = solution.planes.middle
    return contract.Couple(
        about=middle, reach=solution.planes.reach, **_lists(solution.shaking(z=middle), ("mx", "my"))
    )


def _force(solution: Solution, view: ForceView) -> contract.ForceMotion:
    force = solution.mechanism.forces[view.name]
    on_no_markers = view.several or force.kind.on_bodies
    return contract.ForceMotion(
        kind=view.kind,
        actions=[contract.Action(body=body, **_lists(view.on(body), PLACED)) for body in view.bodies],
        several=view.several,
        measures=view.measures,  # pyright: ignore[reportArgumentType]  (the contract lists them)
        value=_list(view.value),
        rate=_list(view.rate),
        effort=_list(view.effort),
        normal=_list(solution.friction(view.name).normal) if force.kind.of_reactions else None,
        power=view.power.tolist(),
        potential=view.potential.tolist(),
        unit=None if view.measures is None else "rad" if view.measures == "angle" else "m",
        effort_unit="N m" if view.measures == "angle" else "N",
        drives=force.kind.drives(force),
        look=_look(force.kind.look, bool(view.potential.any())),
        shape=None if on_no_markers else shape_of(force),
        gas=_gas(force, view),
        gas_behind=_chamber(force, view, "b"),
        hydraulics=_hydraulics(view),
    )


def _acts(wrench: Wrench) -> contract.Acts:
    return contract.Acts(**_lists(wrench, ("x", "y", "torque")))


def _actions(solution: Solution, driver: Joint) -> list[contract.Action]:
    """Return the forces and torques of a driver on its bodies, each where it acts."""
    from mbsd.results.acting import actions

    number = solution.packed.joints.index(driver)
    acting = actions(solution.packed, solution.q, solution.wrench, number)
    return [contract.Action(body=action.body, **_lists(action, PLACED)) for action in acting]


def _look(look: str, holds_energy: bool) -> Look:
    """Return the kind that is drawn: a coil that holds no energy is a damper, such a spiral is not seen."""
    if not holds_energy:
        look = {"coil": "cylinder", "spiral": ""}.get(look, look)
    return look  # pyright: ignore[reportReturnType]  (the contract lists them)


def _gas(force: Force, view: ForceView) -> contract.GasMotion | None:
    """Return the gas motion of a force that comes from gas behind a piston, else None."""
    from mbsd.results.fluids import GasView

    if not isinstance(view, GasView):
        return _chamber(force, view, "a")
    return contract.GasMotion(
        pressure=view.pressure.tolist(),
        volume=view.volume.tolist(),
        outside=force.params["outside"],
        crank=force.params.get("crank"),
        crank_angle=_list(view.crank_angle),
        cycle_angle=view.cycle_angle,
        displaced=view.displaced,
        indicated_work=_list(view.indicated_work),
    )


def _chamber(force: Force, view: ForceView, side: str) -> contract.GasMotion | None:
    """Return the gas in one chamber of a double-acting cylinder, else None."""
    from mbsd.results.fluids import ValvedView

    if not isinstance(view, ValvedView):
        return None
    return contract.GasMotion(
        pressure=getattr(view, f"pressure_{side}").tolist(),
        volume=getattr(view, f"volume_{side}").tolist(),
        outside=force.params["exhaust"],
    )


def _hydraulics(view: ForceView) -> contract.HydraulicMotion | None:
    from mbsd.results.fluids import HydraulicView

    if not isinstance(view, HydraulicView):
        return None
    names = (
        "pressure_a", "pressure_b", "flow_a", "flow_b", "valve", "supply_flow", "supply_power", "valve_loss",
        "leak_loss", "oil_power", "piston_power",
    )  # fmt: skip
    return contract.HydraulicMotion(**_lists(view, names))


def _contact(solution: Solution, name: str, row: int) -> contract.ContactMotion:
    """Return the motion of the contact whose gap is ``row`` of J.

    The way on which it slides is the next one.
    """
    from mbsd.model.joint import ContactKind
    from mbsd.results.acting import acting

    packed, view = solution.packed, solution.contact(name)
    joint = packed.joint_of_row(row)
    assert isinstance(joint.kind, ContactKind)
    number = packed.joints.index(joint)
    fx, fy, torque = solution.wrench[:, number].T
    assert solution.held is not None, "simulations tell which rows held"
    has_friction = joint.params.get("friction", 0.0) > 0.0
    closed = solution.held[:, row]
    sticks = solution.held[:, row + 1] if has_friction else closed
    states: list[contract.State] = [
        "open" if not touches else "sticks" if has_friction and still else "slides" if has_friction else "closed"
        for touches, still in zip(closed.tolist(), sticks.tolist(), strict=True)
    ]
    return contract.ContactMotion(
        kind=joint.kind.name,
        bodies=joint.bodies,
        **_lists(solution.place(joint.j), ("x", "y")),
        fx=fx.tolist(),
        fy=fy.tolist(),
        torque=torque.tolist(),
        **_lists(view, ("gap", "rate", "normal", "friction")),
        state=states,
        unit="rad" if joint.kind.of_angle else "m",
        effort_unit="N m" if joint.kind.of_angle else "N",
        look=joint.kind.look,  # pyright: ignore[reportArgumentType]
        acts=_acts(acting(packed, solution.q, solution.wrench, number)) if joint.kind.touching else None,
        shape=shape_of(joint),
    )


def _lists(view: Any, fields: tuple[str, ...]) -> dict[str, list[float]]:
    return {field: (getattr(view, field) + 0.0).tolist() for field in fields}  # -0 becomes 0


def _list(values: np.ndarray | None) -> list[float] | None:
    return None if values is None else values.tolist()
