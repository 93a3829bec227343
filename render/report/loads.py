"""Loads in the report: reactions, gas and oil."""

from __future__ import annotations

import math

import numpy as np

from render.magnitudes import NOISE
from render.report.written import Amounts, degrees, first_peak, moment, table, written
from shared.contract import Motion

# Gas in cylinders: peak pressure, indicated work of each cycle, mean effective pressure.


def gas_section(motion: Motion) -> list[str]:
    """Return a row for each force that comes from gas behind a piston."""
    rows, amount = [], Amounts(motion)
    for name, force in motion.forces.items():
        gas = force.gas
        if gas is None:
            continue
        pressure = np.array(gas.pressure)
        k = first_peak(pressure)
        at = moment(motion.time[k])
        if gas.crank_angle is not None and gas.cycle_angle is not None:
            turned = (gas.crank_angle[k] + math.pi) % gas.cycle_angle - math.pi
            at = f"{degrees(turned)} after the top, {at}"
        rounding = NOISE * max(gas.volume)
        low, high = (1e6 * (end if end > rounding else 0.0) for end in (min(gas.volume), max(gas.volume)))
        work = gas.indicated_work or []
        mean = float(np.mean(work)) if work else None
        rows.append([
            name, written(float(pressure[k]), "Pa"), at, written(float(pressure.min()), "Pa"),
            f"{written(low, 'cm³')} to {written(high, 'cm³')}",
            "" if mean is None else str(len(work)),
            "" if mean is None else amount(mean, "J"),
            "" if mean is None or gas.displaced is None else written(mean / gas.displaced, "Pa"),
        ])  # fmt: skip
    if not rows:
        return []
    head = [
        "gas", "peak pressure", "at", "least pressure", "volume", "cycles", "indicated work of a cycle",
        "mean effective pressure",
    ]  # fmt: skip
    return ["### Gas", "", *table(head, rows), ""]


# Hydraulic cylinders: highest pressures, oil and energy taken from the supply, and where that goes.


def hydraulics_section(motion: Motion) -> list[str]:
    """Return a row for each hydraulic cylinder."""
    rows, time, amount = [], np.array(motion.time), Amounts(motion)
    for name, force in motion.forces.items():
        cylinder = force.hydraulics
        if cylinder is None:
            continue
        cells = [name]
        for pressure in (np.array(cylinder.pressure_a), np.array(cylinder.pressure_b)):
            k = first_peak(pressure)
            cells.append(f"{written(float(pressure.min()), 'Pa')} to {written(float(pressure[k]), 'Pa')}")
            cells.append(moment(time[k]))
        taken = 1e3 * float(np.trapezoid(np.maximum(cylinder.supply_flow, 0.0), time))
        energies = [
            float(np.trapezoid(part, time))
            for part in (cylinder.supply_power, cylinder.valve_loss, cylinder.piston_power)
        ]
        rows.append([*cells, written(taken, "l"), *(amount(energy, "J") for energy in energies)])
    if not rows:
        return []
    head = ["hydraulic cylinder", "chamber A", "at", "chamber B", "at", "oil taken", "supplied", "lost in the valve",
            "given to the piston"]  # fmt: skip
    return ["### Hydraulics", "", *table(head, rows), ""]


# Loads in a report: reactions, drivers, forces, gas, contacts.

ROUNDING = 1e-9
"""Fraction of what power could do all the time: less is no work."""


def load_section(motion: Motion) -> list[str]:
    """Return reactions, drivers, forces, gas, contacts."""
    time, amount = np.array(motion.time), Amounts(motion)
    lines: list[str] = []
    forces = {name: np.hypot(joint.fx, joint.fy) for name, joint in motion.joints.items()}
    torques = {name: np.abs(joint.torque) for name, joint in motion.joints.items()}
    most = max((float(force.max()) for force in forces.values()), default=0.0)
    if motion.joints and most <= 0.0 and not any(torque.any() for torque in torques.values()):
        lines += ["Nothing loads the joints: no body has a mass, and no force acts.", ""]
    elif motion.joints:
        rows = []
        for name, joint in motion.joints.items():
            k, torque = first_peak(forces[name]), float(torques[name].max())
            rows.append([
                f"{name} ({joint.kind.replace('_', ' ')})", f"{joint.bodies[0]}, {joint.bodies[1]}",
                amount(float(forces[name][k]), "N"), moment(time[k]),
                amount(torque, "N m") if amount.without_noise(torque, "N m") else "",
            ])  # fmt: skip
        lines += ["### Reactions", ""]
        lines += [*table(["joint", "bodies", "peak force", "at", "peak torque"], rows), ""]
    acting = any(force.drives and any(force.effort or ()) for force in motion.forces.values())
    drivers = {name: driver for name, driver in motion.drivers.items() if any(driver.effort) or not acting}
    if drivers:  # of a motion that forces were asked for, the drivers give nothing
        lines += ["### Drivers", ""]
        rows = []
        for name, driver in drivers.items():
            unit = driver.effort_unit
            effort, power = np.array(driver.effort), np.array(driver.power)
            if np.abs(effort).max() <= amount.floors[unit]:  # weights or springs do its work
                effort, power = 0.0 * effort, 0.0 * power
            k = first_peak(np.abs(effort))
            rows.append([
                name, amount(float(effort[k]), unit), moment(time[k]), amount(_rms(effort, time), unit),
                *_powers(power, amount), _work(power, time, amount),
            ])  # fmt: skip
        head = ["driver", "peak effort", "at", "effort, root mean square", "highest power", "lowest power", "work"]
        lines += [*table(head, rows), ""]
    if motion.forces:
        lines += ["### Forces", ""]
        rows = []
        for name, force in motion.forces.items():
            size = np.max([np.hypot(action.fx, action.fy) for action in force.actions], axis=0)
            twist = np.max([np.abs(action.torque) for action in force.actions], axis=0)
            k = first_peak(size if size.any() else twist)
            power = np.array(force.power)
            rows.append([
                f"{name} ({force.kind.replace('_', ' ')})", amount(float(size.max()), "N") if size.any() else "",
                amount(float(twist.max()), "N m") if amount.without_noise(float(twist.max()), "N m") else "",
                moment(time[k]), *_powers(power, amount), _work(power, time, amount),
            ])  # fmt: skip
        head = ["force", "peak force", "peak torque", "at", "gives at most", "takes at most", "work"]
        lines += [*table(head, rows), ""]
    return lines + gas_section(motion) + hydraulics_section(motion) + _contacts(motion, time, amount)


def _contacts(motion: Motion, time: np.ndarray, amount: Amounts) -> list[str]:
    if not motion.contacts:
        return []
    rows = []
    for name, contact in motion.contacts.items():
        normal = np.array(contact.normal)
        closed = np.array([state != "open" for state in contact.state])
        share = float(np.trapezoid(closed, time) / (time[-1] - time[0]))
        hits = [event for event in motion.events if event.what == "impact" and event.name == name]
        hardest = max((abs(event.impulse) for event in hits), default=0.0)
        unit = contact.effort_unit
        rows.append([
            f"{name} ({contact.kind.replace('_', ' ')})", amount(float(normal.max()), unit),
            f"{100 * share:.0f} %", str(len(hits)), written(hardest, f"{unit} s") if hits else "",
        ])  # fmt: skip
    head = ["contact", "peak normal force", "closed", "impacts", "largest impulse"]
    return ["### Contacts", "", *table(head, rows), ""]


def _rms(values: np.ndarray, time: np.ndarray) -> float:
    return math.sqrt(float(np.trapezoid(values**2, time)) / float(time[-1] - time[0]))


def _powers(power: np.ndarray, amount: Amounts) -> tuple[str, str]:
    """Return the highest and the lowest; rounding beside the larger one is nothing."""
    floor = ROUNDING * float(np.abs(power).max(initial=0.0))
    most, least = (amount(value if abs(value) > floor else 0.0, "W") for value in (power.max(), power.min()))
    return most, least


def _work(power: np.ndarray, time: np.ndarray, amount: Amounts) -> str:
    """Return the work over all the time; rounding counts as none."""
    work = float(np.trapezoid(power, time))
    most = float(np.abs(power).max(initial=0.0)) * float(time[-1] - time[0])
    return amount(work if abs(work) > ROUNDING * most else 0.0, "J")
