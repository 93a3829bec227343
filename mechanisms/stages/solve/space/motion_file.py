"""A solution in space as data.json has it: plain lists, author's frames, quaternions with signs that go on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from shared import contract
from shared.contract import space

if TYPE_CHECKING:
    from mbsd.spatial.mechanism import Mechanism
    from mbsd.spatial.model.body import Marker
    from mbsd.spatial.model.force import Force
    from mbsd.spatial.model.joint import Joint
    from mbsd.spatial.results.solution import Solution

XYZ = ("x", "y", "z")
Sources = Mapping[str, Literal["mechanism", "parts"]]


def to_motion3(
    solution: Solution, inks: Mapping[str, str], packages: dict[str, str], sources: Sources
) -> contract.Motion3:
    """Return the solution as the contract has it, its inputs to be filled in.

    ``inks`` are the colours of bodies, ``sources`` says where the mass of each is from.
    """
    import mbsd

    m, energy = solution.mechanism, solution.energy
    return contract.Motion3(
        mechanism=m.name,
        provenance=contract.Provenance(inputs="", versions=packages | {"mbsd": mbsd.__version__}),
        gravity=_triple(m.gravity),
        analysis="sweep" if solution.work is None else "simulation",
        period=solution.period,
        time=solution.t.tolist(),
        bodies=_bodies(solution, m, inks, sources),
        joints={name: _joint(solution, joint) for name, joint in m.joints.items()},
        drivers={name: _driver(solution, driver) for name, driver in m.drivers.items()},
        points={name: _point(solution, name, marker.body.name) for name, marker in m.traces.items()},
        forces={name: _force(solution, force) for name, force in m.forces.items()},
        energy=contract.Energy(
            kinetic=energy.kinetic.tolist(),
            potential=energy.potential.tolist(),
            work=None if solution.work is None else solution.work.tolist(),
        ),
        start_changes=list(solution.changes),
        diagnostics=contract.Diagnostics(
            position_residual=solution.stats.position_residual,
            velocity_residual=solution.stats.velocity_residual,
            acceleration_residual=solution.stats.acceleration_residual,
            power_residual=solution.stats.power_residual,
            dof=solution.mobility.dof,
            redundant=list(solution.mobility.redundant),
            singularity_margin=solution.motion.margin[solution.wanted].tolist(),
        ),
    )


def _bodies(
    solution: Solution, m: Mechanism, inks: Mapping[str, str], sources: Sources
) -> dict[str, space.BodyMotion3]:
    from mbsd.drawing.look import on_dark

    out = {}
    for name, body in m.bodies.items():
        if name == "ground":
            continue
        view, inertia = solution.body(name), np.array(body.inertia)
        out[name] = space.BodyMotion3(
            **_columns(XYZ, view.place),
            **_columns(("qw", "qx", "qy", "qz"), signs_go_on(view.orientation)),
            **_columns(("vx", "vy", "vz"), view.velocity),
            **_columns(("wx", "wy", "wz"), view.w),
            **_columns(("ax", "ay", "az"), view.acceleration),
            **_columns(("alphax", "alphay", "alphaz"), view.alpha),
            mass=body.mass,
            mass_from=sources[name],
            com=_triple(body.com),
            inertia=_six(inertia),
            colour=inks[name],
            colour_on_dark=on_dark(inks[name]),
        )
    return out


def signs_go_on(e: np.ndarray) -> np.ndarray:
    """Return quaternions (T, 4) of length 1, each with the sign nearer to the one before; the first has w >= 0."""
    unit = e / np.linalg.norm(e, axis=1, keepdims=True)
    turned = np.where((unit[1:] * unit[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    first = -1.0 if unit[0][np.flatnonzero(np.abs(unit[0]) > 1e-12)[0]] < 0.0 else 1.0
    return unit * (first * np.cumprod(np.concatenate([[1.0], turned])))[:, None]


def _joint(solution: Solution, joint: Joint) -> space.JointMotion3:
    view = solution.joint(joint.name)
    axis = view.axis / np.linalg.norm(view.axis, axis=1, keepdims=True)
    return space.JointMotion3(
        kind=joint.kind.name,
        bodies=joint.bodies,
        markers=(_marker(joint.i), _marker(joint.j)),
        **_columns(XYZ, view.place),
        **_columns(("ux", "uy", "uz"), axis),
        **_columns(("fx", "fy", "fz"), view.force),
        **_columns(("mx", "my", "mz"), view.moment),
        turn=view.turn.tolist() if view.turns is not None else None,
        slide=view.slide.tolist() if view.slides is not None else None,
    )


def _driver(solution: Solution, driver: Joint) -> space.DriverMotion3:
    view = solution.driver(driver.name)
    return space.DriverMotion3(
        kind=driver.kind.name.removeprefix("drive_"),
        bodies=driver.bodies,
        joint=driver.coupled[0].name if driver.coupled else None,
        unit="rad" if driver.kind.angular else "m",
        effort_unit="N m" if driver.kind.angular else "N",
        value=view.value.tolist(),
        effort=(view.effort + 0.0).tolist(),
        power=(view.power + 0.0).tolist(),
    )


def _force(solution: Solution, force: Force) -> space.ForceMotion3:
    view: Any = solution.force(force.name)
    angular = bool(force.pushes) and force.pushes[0].row.unit == "rad"
    rows = zip(view.values.T, view.rates.T, view.efforts.T, strict=True) if force.pushes else ()
    wrench = (
        {} if force.pushes else _columns(("fx", "fy", "fz"), view.force) | _columns(("mx", "my", "mz"), view.moment)
    )
    return space.ForceMotion3(
        kind=force.kind.name,
        bodies=(force.i.body.name, force.j.body.name),
        markers=(_marker(force.i), _marker(force.j)),
        unit="rad" if angular else "m",
        effort_unit="N m" if angular else "N",
        look=force.kind.look,  # pyright: ignore[reportArgumentType]
        rows=[space.Row3(value=v.tolist(), rate=r.tolist(), effort=(e + 0.0).tolist()) for v, r, e in rows],
        **wrench,
        power=(view.power + 0.0).tolist(),
    )


def _point(solution: Solution, name: str, body: str) -> space.PointMotion3:
    view = solution.point(name)
    return space.PointMotion3(
        body=body,
        **_columns(XYZ, view.place),
        **_columns(("vx", "vy", "vz"), view.velocity),
        **_columns(("ax", "ay", "az"), view.acceleration),
    )


def _marker(marker: Marker) -> space.Marker3:
    return space.Marker3(place=_triple(marker.place), axis=_triple(marker.axis), across=_triple(marker.across))


def _triple(values: Any) -> tuple[float, float, float]:
    x, y, z = (float(value) + 0.0 for value in values)  # -0 becomes 0
    return x, y, z


def _six(inertia: np.ndarray) -> tuple[float, float, float, float, float, float]:
    """Return xx, yy, zz, xy, xz, yz of a matrix (3, 3)."""
    xx, yy, zz, xy, xz, yz = (float(inertia[i, j]) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
    return xx, yy, zz, xy, xz, yz


def _columns(names: tuple[str, ...], values: np.ndarray) -> dict[str, list[float]]:
    return {name: (column + 0.0).tolist() for name, column in zip(names, values.T, strict=True)}
