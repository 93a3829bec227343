"""A solution as data.json has it: plain lists, author's frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shared import contract

if TYPE_CHECKING:
    from mbsd import Solution


def to_motion(
    solution: Solution, parts: contract.Parts | None, inputs: str, packages: dict[str, str]
) -> contract.Motion:
    """The solution as the contract has it; without ``parts`` bodies have no height."""
    import mbsd

    m = solution.mechanism
    frame_fields = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")
    bodies = {
        name: contract.BodyMotion(
            **{field: getattr(solution.body(name), field).tolist() for field in frame_fields},
            z=parts.bodies[name].z if parts else None,
            mass=body.mass,
            com=body.com,
            inertia=body.inertia,
        )
        for name, body in m.bodies.items()
        if name != "ground"
    }
    joints = {
        name: contract.JointMotion(
            kind=joint.kind.name,
            bodies=joint.bodies,
            **{field: getattr(solution.joint(name), field).tolist() for field in ("x", "y", "fx", "fy", "torque")},
        )
        for name, joint in m.joints.items()
    }
    drivers = {
        name: contract.DriverMotion(
            kind=driver.kind.name.removeprefix("drive_"),
            **{field: getattr(solution.driver(name), field).tolist() for field in ("value", "effort", "power")},
        )
        for name, driver in m.drivers.items()
    }
    points = {
        name: contract.PointMotion(
            body=marker.body.name,
            **{field: getattr(solution.point(name), field).tolist() for field in ("x", "y", "vx", "vy", "ax", "ay")},
        )
        for name, marker in m.traces.items()
    }
    stats = solution.stats
    return contract.Motion(
        mechanism=m.name,
        provenance=contract.Provenance(inputs=inputs, versions=packages | {"mbsd": mbsd.__version__}),
        gravity=(float(m.gravity[0]), float(m.gravity[1])) if m.gravity else (0.0, 0.0),
        period=solution.period,
        time=solution.t.tolist(),
        bodies=bodies,
        joints=joints,
        drivers=drivers,
        points=points,
        energy=contract.Energy(kinetic=solution.energy.kinetic.tolist(), potential=solution.energy.potential.tolist()),
        events=[
            contract.EventMark(time=event.time, name=event.name, what=event.what, energy=event.energy)
            for event in solution.events
        ],
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
