"""A solution as data.json has it: plain lists, author's frames."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mechanisms.stages.solve.body_colours import body_colours
from mechanisms.stages.solve.masses import Source
from mechanisms.stages.solve.shapes import shape_of
from mechanisms.stages.solve.vibration import vibration
from shared import contract

if TYPE_CHECKING:
    import numpy as np

    from mbsd import Force, Joint, Solution
    from mbsd.results.force_view import ForceView
    from mbsd.results.views import Wrench
    from shared.contract.loads import Look

FRAME = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")
PLACED = ("x", "y", "fx", "fy", "torque")


def to_motion(
    solution: Solution,
    parts: contract.Parts | None,
    inputs: str,
    packages: dict[str, str],
    sources: Mapping[str, Source] | None = None,
) -> contract.Motion:
    """The solution as the contract has it; bodies without solids have no height.

    Times at which efforts do not exist are left out, and its notes say so.
    ``sources`` says where the mass of each body is from; if it is not given, from the parts.
    """
    import mbsd
    from mbsd.drawing.inks import on_dark
    from mbsd.results.releases import release_times

    notes = list(solution.notes)
    solution = solution.only(solution.is_defined) if notes else solution
    inks, released = body_colours(solution.mechanism, parts), release_times(solution)
    m, stats, energy = solution.mechanism, solution.stats, solution.energy
    bodies = {
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
        for name, body in m.bodies.items()
        if name != "ground"
    }
    return contract.Motion(
        mechanism=m.name,
        provenance=contract.Provenance(inputs=inputs, versions=packages | {"mbsd": mbsd.__version__}),
        gravity=(float(m.gravity[0]), float(m.gravity[1])) if m.gravity else (0.0, 0.0),
        analysis="sweep" if solution.work is None else "simulation",
        period=solution.period,
        time=solution.t.tolist(),
        bodies=bodies,
        joints={
            name: contract.JointMotion(
                kind=joint.kind.name,
                bodies=joint.bodies,
                **_lists(solution.joint(name), PLACED),
                pair=joint.kind.pair,  # pyright: ignore[reportArgumentType]  (the contract lists them)
                look=joint.kind.look,  # pyright: ignore[reportArgumentType]
                acts=_acts(solution.joint(name).acts) if joint.kind.touching else None,
                shape=shape_of(joint),
                released=released.get(name),
            )
            for name, joint in m.joints.items()
        },
        drivers={
            name: contract.DriverMotion(
                kind=driver.kind.name.removeprefix("drive_"),
                bodies=driver.bodies,
                unit="rad" if driver.kind.angular else "m",
                effort_unit="N m" if driver.kind.angular else "N",
                look=driver.kind.look,  # pyright: ignore[reportArgumentType]
                actions=_actions(solution, driver),
                shape=shape_of(driver),
                **_lists(solution.driver(name), ("value", "effort", "power")),
            )
            for name, driver in m.drivers.items()
        },
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
        diagnostics=contract.Diagnostics(
            position_residual=stats.position_residual,
            velocity_residual=stats.velocity_residual,
            acceleration_residual=stats.acceleration_residual,
            power_residual=stats.power_residual,
            dof=solution.mobility.dof,
            redundant=list(solution.mobility.redundant),
            singularity_margin=solution.singularity_margin.tolist(),
        ),
    )


def _couple(solution: Solution) -> contract.Couple | None:
    """About the middle of the bodies along the normal of the plane."""
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
        hydraulics=_hydraulics(view),
    )


def _acts(wrench: Wrench) -> contract.Acts:
    return contract.Acts(**_lists(wrench, ("x", "y", "torque")))


def _actions(solution: Solution, driver: Joint) -> list[contract.Action]:
    """What a driver does to its bodies, each where it acts."""
    from mbsd.results.acting import actions

    number = solution.packed.joints.index(driver)
    acting = actions(solution.packed, solution.q, solution.wrench, number)
    return [contract.Action(body=action.body, **_lists(action, PLACED)) for action in acting]


def _look(look: str, holds_energy: bool) -> Look:
    """A coil that holds no energy is a damper, such a spiral nothing that is seen."""
    if not holds_energy:
        look = {"coil": "cylinder", "spiral": ""}.get(look, look)
    return look  # pyright: ignore[reportReturnType]  (the contract lists them)


def _gas(force: Force, view: ForceView) -> contract.GasMotion | None:
    """Gas motion of a force that comes from gas behind a piston, else None."""
    from mbsd.results.gas import GasView

    if not isinstance(view, GasView):
        return None
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


def _hydraulics(view: ForceView) -> contract.HydraulicMotion | None:
    from mbsd.results.hydraulics import HydraulicView

    if not isinstance(view, HydraulicView):
        return None
    names = (
        "pressure_a", "pressure_b", "flow_a", "flow_b", "valve", "supply_flow", "supply_power", "valve_loss",
        "leak_loss", "oil_power", "piston_power",
    )  # fmt: skip
    return contract.HydraulicMotion(**_lists(view, names))


def _contact(solution: Solution, name: str, row: int) -> contract.ContactMotion:
    """Motion of the contact whose gap is ``row`` of J; the way on which it slides is the next one."""
    from mbsd.model.contact import ContactKind
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
