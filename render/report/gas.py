"""Gas in cylinders: peak pressure, indicated work of each cycle, mean effective pressure."""

from __future__ import annotations

import math

import numpy as np

from render.magnitudes import NOISE
from render.report.written import Amounts, degrees, first_peak, moment, table, written
from shared.contract import Motion


def gas_section(motion: Motion) -> list[str]:
    """A row for each force that comes from gas behind a piston."""
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
