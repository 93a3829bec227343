"""The report of a mechanism in space: how it moves, what joints carry, masses and energy."""

from __future__ import annotations

import math

import numpy as np

from render.report.written import counted, listed, moment, speed, table, turning, written
from shared.contract import Motion3, Parts
from shared.contract.quantity import figures
from shared.contract.space import columns

NOISE = 1e-9
"""Part of the largest value that is rounding."""
XYZ = "xyz"


def sections_in_space(motion: Motion3, parts: Parts | None) -> list[tuple[str, list[str]]]:
    """Return headings and lines; a section without lines is left out."""
    return [
        ("Travel", travel_section(motion)),
        ("Speeds", speed_section(motion)),
        ("Loads", load_section(motion)),
        ("Energy", energy_section(motion)),
        ("Masses", mass_section(motion, parts)),
    ]


def motion_in_space(motion: Motion3) -> list[str]:
    """Return the mobility, what was solved, and how well it closes."""
    diagnostics, span = motion.diagnostics, motion.time[-1] - motion.time[0]
    moved = f"driven by {listed(list(motion.drivers))}" if motion.drivers else "moved by forces alone"
    repeats = f"; it repeats after {moment(motion.period)}" if motion.period else ""
    lines = [
        f"The mechanism moves in space, has {counted(diagnostics.dof, 'degree')} of freedom and is {moved}. The "
        f"{motion.analysis} has {counted(len(motion.time), 'time')} over {moment(span)}{repeats}.",
        "",
        f"Joints close to {diagnostics.position_residual:.1e} (m or rad); velocities fulfil their equations to "
        f"{diagnostics.velocity_residual:.1e} and accelerations to {diagnostics.acceleration_residual:.1e}.",
    ]
    if diagnostics.redundant:
        repeated = ", ".join(diagnostics.redundant)
        words = f"Joints that repeat what others hold: {repeated}. Their share of the load is that of least norm."
        lines += ["", words]
    if motion.start_changes:
        lines += ["", "The given start was made consistent:", "", *(f"- {change}" for change in motion.start_changes)]
    return lines


def travel_section(motion: Motion3) -> list[str]:
    """Return how far joints turn and slide, and the box of each traced point."""
    rows = []
    for name, joint in motion.joints.items():
        turn = "" if joint.turn is None else f"{math.degrees(max(joint.turn) - min(joint.turn)):.1f}°"
        slide = "" if joint.slide is None else written(max(joint.slide) - min(joint.slide), "m")
        if turn or slide:
            rows.append([f"joint {name}", turn, slide, "", "", ""])
    for name, point in motion.points.items():
        spans = [written(float(np.ptp(getattr(point, axis))), "m") for axis in XYZ]
        rows.append([f"point {name}", "", "", *spans])
    return table(["", "turn", "slide", "x", "y", "z"], rows) if rows else []


def speed_section(motion: Motion3) -> list[str]:
    """Return the largest speeds of bodies and traced points."""
    rows = []
    for name, body in motion.bodies.items():
        w = np.linalg.norm(columns(body, "wx", "wy", "wz"), axis=1)
        v = np.linalg.norm(columns(body, "vx", "vy", "vz"), axis=1)
        rows.append([name, turning(float(w.max())), speed(float(v.max()))])
    for name, point in motion.points.items():
        v = np.linalg.norm(columns(point, "vx", "vy", "vz"), axis=1)
        rows.append([f"point {name}", "", speed(float(v.max()))])
    return table(["", "turns at", "frame or point moves at"], rows)


def load_section(motion: Motion3) -> list[str]:
    """Return the largest force and moment of each joint, across and along its axis, and efforts of drivers."""
    rows, forces, moments = [], {}, {}
    for name, joint in motion.joints.items():
        axis = columns(joint, "ux", "uy", "uz")
        forces[name], moments[name] = (
            _across_and_along(columns(joint, *fields), axis) for fields in (("fx", "fy", "fz"), ("mx", "my", "mz"))
        )
    weak, slack = (NOISE * max((max(pair) for pair in each.values()), default=0.0) for each in (forces, moments))
    for name, joint in motion.joints.items():
        numbers = [written(value if value > weak else 0.0, "N") for value in forces[name]]
        numbers += [written(value if value > slack else 0.0, "N m") for value in moments[name]]
        rows.append([name, joint.kind, *numbers])
    lines = (
        table(["joint", "kind", "force across", "force along", "moment across", "moment along"], rows) if rows else []
    )
    for name, driver in motion.drivers.items():
        peak = float(np.abs(driver.effort).max())
        power = float(np.max(driver.power))
        lines += ["", f"The driver {name} gives up to {written(peak, driver.effort_unit)} and {written(power, 'W')}."]
    return lines


def _across_and_along(values: np.ndarray, axis: np.ndarray) -> tuple[float, float]:
    along = (values * axis).sum(axis=1)
    return float(np.linalg.norm(values - along[:, None] * axis, axis=1).max()), float(np.abs(along).max())


def energy_section(motion: Motion3) -> list[str]:
    """Return the span of the energies."""
    kinetic, potential = (np.asarray(part) for part in (motion.energy.kinetic, motion.energy.potential))
    total = kinetic + potential
    low, high = (written(float(value), "J") for value in (kinetic.min(), kinetic.max()))
    varies = written(float(np.ptp(potential)), "J")
    lines = [f"The kinetic energy is between {low} and {high}, the potential energy varies by {varies}."]
    if not motion.drivers and not any(any(force.power) for force in motion.forces.values()):
        lines.append(f"Nothing gives or takes energy: the sum stays within {written(float(np.ptp(total)), 'J')}.")
    return lines


def mass_section(motion: Motion3, parts: Parts | None) -> list[str]:
    """Return masses, centres of mass and principal moments."""
    rows = []
    for name, body in motion.bodies.items():
        xx, yy, zz, xy, xz, yz = body.inertia
        moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        centre = ", ".join(figures(1000 * value, 3) for value in body.com)
        rows.append(
            [name, body.mass_from, written(body.mass, "kg"), centre, ", ".join(f"{value:.3g}" for value in moments)]
        )
    lines = table(["", "from", "mass", "centre of mass (mm)", "principal moments (kg m²)"], rows)
    if parts is not None:
        lines += ["", f"All parts weigh {written(sum(body.mass.mass for body in parts.bodies.values()), 'kg')}."]
    return lines


def facts_in_space(motion: Motion3, parts: Parts | None) -> list[str]:
    """Return freedoms, time, the fastest point, efforts, the largest reaction and the mass, for a card."""
    out = [f"{counted(motion.diagnostics.dof, 'degree')} of freedom in space"]
    out.append(f"repeats after {moment(motion.period)}" if motion.period else f"{moment(motion.time[-1])} of motion")
    peaks = {
        name: float(np.linalg.norm(columns(p, "vx", "vy", "vz"), axis=1).max()) for name, p in motion.points.items()
    }
    if peaks:
        fastest = max(peaks, key=lambda name: peaks[name])
        out.append(f"{fastest} reaches {speed(peaks[fastest])}")
    forces = {n: float(np.linalg.norm(columns(j, "fx", "fy", "fz"), axis=1).max()) for n, j in motion.joints.items()}
    largest = max(forces.values(), default=0.0)
    for name, driver in motion.drivers.items():
        effort = float(np.abs(driver.effort).max())
        if effort > NOISE * largest:
            out.append(f"{name} up to {written(effort, driver.effort_unit)}")
    if largest > 0.0:
        out.append(f"largest reaction {written(largest, 'N')} at {max(forces, key=lambda name: forces[name])}")
    if parts is not None:
        pieces = sum(len(body.pieces) for body in parts.bodies.values())
        moving = sum(body.mass for body in motion.bodies.values())
        out.append(f"{written(moving, 'kg')} moving, {counted(pieces, 'piece')}")
    return out
