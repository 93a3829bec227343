"""Hydraulic cylinders: highest pressures, oil and energy taken from the supply, and where that goes."""

from __future__ import annotations

import numpy as np

from render.report.written import Amounts, first_peak, moment, table, written
from shared.contract import Motion


def hydraulics_section(motion: Motion) -> list[str]:
    """A row for each hydraulic cylinder."""
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
