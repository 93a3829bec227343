"""Sections of a report, each a list of lines of Markdown from data.json and the files beside it."""

from __future__ import annotations

import numpy as np

from render.magnitudes import crank_of, driven_bodies, shaking, travels
from render.report.written import Amounts, counted, first_peak, listed, moment, speed, table, turning, written
from shared.contract import Motion, Parts
from shared.contract.clearance import Clearance
from shared.contract.quantity import figures

G = 9.80665


def motion_section(motion: Motion) -> list[str]:
    """Return the mobility, what was solved, how well it closes."""
    diagnostics, span = motion.diagnostics, motion.time[-1] - motion.time[0]
    drivers = listed(list(motion.drivers)) if motion.drivers else ""
    moved = f"driven by {drivers}" if drivers else "moved by forces alone"
    times = f"{counted(len(motion.time), 'time')} over {moment(span)}"
    kind = "simulation" if motion.analysis == "simulation" else "sweep"
    repeats = f"; it repeats after {moment(motion.period)}" if motion.period else ""
    lines = [
        f"The mechanism has {counted(diagnostics.dof, 'degree')} of freedom and is {moved}. "
        f"The {kind} has {times}{repeats}.",
        "",
        f"Joints close to {diagnostics.position_residual:.1e} (m or rad); velocities fulfil their equations to "
        f"{diagnostics.velocity_residual:.1e} and accelerations to {diagnostics.acceleration_residual:.1e} "
        "(by s, by s²).",
    ]
    if diagnostics.redundant:
        repeated = ", ".join(diagnostics.redundant)
        words = f"Joints that repeat what others hold: {repeated}. Their share of the load is that of least norm."
        lines += ["", words]
    margin = np.array(diagnostics.singularity_margin)
    if len(margin) and margin.min() < 0.02:
        k = int(margin.argmin())
        lines += ["", f"It comes near a singular pose at t = {moment(motion.time[k])}, where its margin is "
                  f"{margin[k]:.2g} (0 at a toggle or change point, 1 at best)."]  # fmt: skip
    if motion.start_changes:
        lines += ["", "The given start was made consistent:", "", *(f"- {change}" for change in motion.start_changes)]
    if motion.notes:
        lines += ["", "Times left out because efforts do not exist there:", "", *(f"- {note}" for note in motion.notes)]
    return lines


def speed_section(motion: Motion) -> list[str]:
    """Return the peak speeds and accelerations of centres of mass and traced points, peak turning."""
    time, rows, centres, amount = motion.time, [], {}, Amounts(motion)
    for name, body in motion.bodies.items():
        theta, omega, alpha = (np.array(part) for part in (body.theta, body.omega, body.alpha))
        x, y = body.com
        arm = np.stack([np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y])
        v = np.hypot(np.array(body.vx) - omega * arm[1], np.array(body.vy) + omega * arm[0])
        a = np.hypot(
            np.array(body.ax) - alpha * arm[1] - omega**2 * arm[0],
            np.array(body.ay) + alpha * arm[0] - omega**2 * arm[1],
        )
        centres[name] = v, a, float(np.abs(omega).max())
    for name, (v, a, spin) in centres.items():
        k = first_peak(v)
        spins = turning(spin) if amount.without_noise(spin, "rad/s") else "0"
        moves = amount.without_noise(float(v[k]), "m/s")
        fast = speed(float(v[k]), travels(motion, name))
        shown = (fast, moment(time[k]), _acceleration(a, amount)) if moves else ("0", "", "0")
        rows.append([name, *shown, spins])
    for name, point in motion.points.items():
        v, a = np.hypot(point.vx, point.vy), np.hypot(point.ax, point.ay)
        k = first_peak(v)
        fast = speed(float(v[k]), travels(motion, name))
        rows.append([f"point {name}", fast, moment(time[k]), _acceleration(a, amount), ""])
    lines = ["Bodies by their centres of mass, and traced points.", ""]
    lines += table(["", "peak speed", "at", "peak acceleration", "peak turning"], rows)
    return lines + _last_turn(motion)


def _last_turn(motion: Motion) -> list[str]:
    """Return how evenly a crank turns that forces turn: after the run-up, over its last turn."""
    crank = crank_of(motion)
    if crank is None or crank.turns < 2 or crank.body in driven_bodies(motion):
        return []
    last = crank.angle >= crank.angle[-1] - 2 * np.pi
    spins = np.abs(np.array(motion.bodies[crank.body].omega))[last]
    time = np.array(motion.time)[last]
    mean, most, least = float(np.trapezoid(spins, time) / np.ptp(time)), float(spins.max()), float(spins.min())
    return [
        "",
        f"In its last turn the {crank.body} has {turning(mean)} on average, at least {written(least, 'rad/s')} and at "
        f"most {written(most, 'rad/s')}: its speed fluctuates by "
        f"{figures(100 * (most - least) / mean, 2)} % of the mean.",
    ]


def frame_section(motion: Motion) -> list[str]:
    """Return the lines on inertia forces on the frame, for bodies at different heights.

    Heights are along the normal of the plane.
    """
    shaken = shaking(motion)
    if shaken.mx is None or shaken.my is None:
        return []
    rows = [
        ["force", *(written(float(np.abs(values).max()), "N") for values in (shaken.fx, shaken.fy)), ""],
        ["couple", *(written(float(np.abs(values).max()), "N m") for values in (shaken.mx, shaken.my)), ""],
        ["moment", "", "", written(float(np.abs(shaken.moment).max()), "N m")],
    ]
    lines = [f"Largest force of inertia, couples about x and y, and moment about {shaken.about}.", ""]
    return lines + table(["", "x", "y", "z"], rows)


def energy_section(motion: Motion) -> list[str]:
    """Return kinetic and potential energy, and how well the balance holds."""
    amount = Amounts(motion)
    kinetic, potential = np.array(motion.energy.kinetic), np.array(motion.energy.potential)
    total = kinetic + potential
    k = first_peak(kinetic)
    lines = [
        f"Kinetic energy is at most {amount(float(kinetic[k]), 'J')} (t = {moment(motion.time[k])}); potential energy "
        f"changes by {amount(float(np.ptp(potential)), 'J')}, their sum by {amount(float(np.ptp(total)), 'J')}."
    ]
    lost = -sum(event.energy for event in motion.events)
    if amount.without_noise(lost, "J"):
        hits = sum(event.what == "impact" for event in motion.events)
        lines += ["", f"Impacts and other events ({counted(hits, 'impact')}) take {written(lost, 'J')}."]
    if motion.energy.audit is not None:
        time, audit = np.array(motion.time), np.array(motion.energy.audit)
        for event in motion.events:
            after = time > event.time
            twins = np.flatnonzero(np.isclose(time, event.time, rtol=0, atol=0))
            if len(twins) > 1:
                after[twins[-1]] = True
            elif len(twins):
                after[twins] = True
            audit = audit - np.where(after, event.energy, 0.0)
        drift = float(np.abs(audit - audit[0]).max())
        scale = max(float(kinetic.max()), float(np.ptp(potential)), 1e-300)
        lines += ["", f"The balance of energy, with the work of all forces and what events take, drifts by "
                  f"{amount(drift, 'J', 2)}: {drift / scale:.1e} of the largest exchange."]  # fmt: skip
    else:
        lines += ["", f"The power of the drivers differs from the change of energy by at most "
                  f"{amount(motion.diagnostics.power_residual, 'W')}."]  # fmt: skip
    return lines


def mass_section(motion: Motion, parts: Parts | None) -> list[str]:
    """Return masses and where they are from."""
    words = {"mechanism": "mechanism.py", "parts": "the parts", "estimate": "an estimate"}
    rows = [
        [name, written(body.mass, "kg"), _place(body.com), written(body.inertia, "kg m²"), words[body.mass_from]]
        for name, body in motion.bodies.items()
    ]
    total = sum(body.mass for body in motion.bodies.values())
    lines = [f"All that moves weighs {written(total, 'kg')}."]
    if parts is not None and "ground" in parts.bodies:
        pieces = sum(len(body.pieces) for body in parts.bodies.values())
        frame = written(parts.bodies["ground"].mass.mass, "kg")
        lines[0] += f" The frame weighs {frame}; there {'is' if pieces == 1 else 'are'} {counted(pieces, 'piece')}."
    if parts is not None and parts.without_solids:
        lines[0] += f" Without solids: {', '.join(parts.without_solids)}."
    lines.append("")
    return lines + table(["body", "mass", "centre of mass", "inertia", "from"], rows)


def clearance_section(clearance: Clearance | None) -> list[str]:
    """Return the least gap between two parts, and what was not compared."""
    if clearance is None:
        return ["It was not checked: there is no clearance.json of this motion."]
    lines = [_nearest(clearance)]
    if clearance.may_touch:
        pairs = "; ".join(" and ".join(pair) for pair in clearance.may_touch)
        lines += ["", f"Bodies that touch by design were not compared with each other: {pairs}."]
    if clearance.pieces_may_touch:
        pairs = "; ".join(" and ".join(pair) for pair in clearance.pieces_may_touch)
        lines += ["", f"Pieces that touch by design were not compared with each other: {pairs}."]
    return lines


def _nearest(clearance: Clearance) -> str:
    if not clearance.pairs:
        return f"No two parts of different bodies come near each other; {counted(clearance.apart, 'pair')} stay apart."
    nearest = min(clearance.pairs, key=lambda pair: pair.gap)
    when = "" if nearest.time is None else f" at t = {moment(nearest.time)}"
    names = " and ".join(f"{piece} ({body})" for piece, body in zip(nearest.pieces, nearest.bodies, strict=True))
    return (
        f"No two parts touch. {names} come nearest, to {written(nearest.gap, 'm')}{when}; less than "
        f"{written(nearest.proven, 'm')} is ruled out over the whole motion. {counted(len(clearance.pairs), 'pair')} "
        f"of pieces were looked at closely, {clearance.apart} never come near."
    )


def _acceleration(a: np.ndarray, amount: Amounts) -> str:
    most = amount.without_noise(float(a.max()), "m/s²")
    return f"{written(most, 'm/s²')} ({figures(most / G, 2)} g)" if most else "0"


def _place(at: tuple[float, float]) -> str:
    x, y = (round(1e3 * part, 2) + 0.0 for part in at)  # -0 becomes 0
    return f"{x:.2f}, {y:.2f} mm".replace("-", "\N{MINUS SIGN}")
