"""Pages of forces and of the shaking of the frame."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure

from render.magnitudes import (
    NOISE,
    couple_floor,
    force_floor,
    force_scale,
    power_floor,
    shaking,
    torque_scale,
    without_noise,
)
from render.plots.measures import dress_plane, horizon
from render.plots.pages.motion import draw
from render.plots.style import INK, PALETTE, SIZE, acting_on, ink_of, insight_under, page, rows
from shared.contract import Motion
from shared.contract.quantity import written

# Loads of joints, drivers and forces: reactions, hodographs, forces.

TITLE, LETTER = 9.5, 0.56
"""Size of a title (points), and the width of a letter in it."""
BETWEEN = 0.62
"""Inches between two rows of hodographs for the words below the upper and a line of title above the lower one."""
BESIDE = 0.62
"""Inches between two columns of hodographs for the numbers and words of the right one."""
PANELS = 12
"""Hodographs on one page; of more joints, those with the largest reactions."""


def reactions(motion: Motion) -> Figure:
    """Return the size of every joint's reaction (N), its torque (N m) if any, and the drivers' effort."""
    over = horizon(motion)
    weak, slack = NOISE * force_scale(motion), NOISE * torque_scale(motion)
    forces = [(n, np.hypot(joint.fx, joint.fy), ink_of(motion, joint.bodies)) for n, joint in motion.joints.items()]
    torques = [
        (name, np.asarray(joint.torque), ink_of(motion, joint.bodies))
        for name, joint in motion.joints.items()
        if np.abs(joint.torque).max() > slack
    ]
    turning, pushing = [], []
    for name, driver in motion.drivers.items():
        panel = turning if driver.effort_unit == "N m" else pushing
        panel.append((name, np.asarray(driver.effort), ink_of(motion, driver.bodies or ())))
    panels = [
        ("reaction force", "N", forces),
        ("reaction torque", "N m", torques),
        ("driver torque", "N m", turning),
        ("driver force", "N", pushing),
    ]
    panels = [panel for panel in panels if panel[2]]
    figure = page(
        motion.mechanism,
        "what the joints carry",
        "magnitude of each joint's reaction, and what the driver must give",
        insight_under(motion, "peak_cause", "peak_weight", "ripple"),
    )
    for axes, (words, unit, lines) in zip(rows(figure, len(panels)), panels, strict=True):
        draw(axes, over, words, unit, lines, floor=slack if unit == "N m" else weak)
    over.dress(figure.axes[-1])
    return figure


def forces(motion: Motion) -> Figure:
    """Return signed forces (N) and torques (N m), normal forces of rigid contacts, and powers (W)."""
    over = horizon(motion)
    weak, slack = NOISE * force_scale(motion), NOISE * torque_scale(motion)
    pushing, turning, giving = [], [], []
    for name, force in motion.forces.items():
        ink = acting_on(motion, name)
        if force.effort is not None:
            (turning if force.effort_unit == "N m" else pushing).append((name, np.asarray(force.effort), ink))
        elif len(force.actions) == 1:
            sizes = np.hypot(force.actions[0].fx, force.actions[0].fy)
            pushing.append((f"|{name}|", sizes, ink))
        giving.append((name, np.asarray(force.power), ink))
    for name, contact in motion.contacts.items():
        panel = turning if contact.effort_unit == "N m" else pushing
        panel.append((name, np.asarray(contact.normal), ink_of(motion, contact.bodies)))
    panels = [
        ("force", "N", pushing, weak),
        ("torque", "N m", turning, slack),
        ("power", "W", giving, power_floor(motion)),
    ]
    panels = [panel for panel in panels if panel[2]]
    figure = page(
        motion.mechanism,
        "what the forces do",
        "positive where it makes its length, angle or gap grow; power: what it gives to the motion",
        insight_under(motion, "work_share", "isolation", "impact", "gas", "losses"),
    )
    for axes, (words, unit, lines, floor) in zip(rows(figure, len(panels)), panels, strict=True):
        draw(axes, over, words, unit, lines, floor=floor)
    over.dress(figure.axes[-1])
    return figure


def hodographs(motion: Motion) -> Figure:
    """Return the path of each joint's reaction vector (N) over the motion, with a dot at the start.

    Vectors are drawn from the origin.
    """
    weak = NOISE * force_scale(motion)
    sizes = {name: float(np.hypot(joint.fx, joint.fy).max()) for name, joint in motion.joints.items()}
    largest = sorted((name for name in sizes if sizes[name] > weak), key=lambda name: -sizes[name]) or list(sizes)
    shown = [name for name in motion.joints if name in largest[:PANELS]]
    figure = page(
        motion.mechanism,
        "reactions by direction",
        "tip of the force on the joint's second body, world axes; the dot marks the start, the arrow the largest",
    )
    columns = min(len(shown), max(3, math.ceil(math.sqrt(len(shown)))) if len(shown) != 4 else 2)
    lines = math.ceil(len(shown) / columns)
    grid = figure.subplots(lines, columns, squeeze=False).ravel()
    heads = {name: f"{name}: {motion.joints[name].bodies[0]} on {motion.joints[name].bodies[1]}" for name in shown}
    peaks = {name: f"at most {written(sizes[name], 'N')}" for name in shown}
    figure.subplots_adjust(
        left=0.07, right=0.975, top=0.83, bottom=0.085, wspace=_spacing(columns, BESIDE, 0.905 * SIZE[0])
    )
    room = grid[0].get_position().width * SIZE[0] * 72 / (LETTER * TITLE)
    is_long = any(len(heads[name]) + len(peaks[name]) + 2 > room for name in shown)
    figure.subplots_adjust(hspace=_spacing(lines, BETWEEN + TITLE * 1.2 / 72 * is_long, 0.745 * SIZE[1]))
    for axes, name in zip(grid, shown, strict=False):
        joint = motion.joints[name]
        fx, fy = without_noise(np.asarray(joint.fx), weak), without_noise(np.asarray(joint.fy), weak)
        ink = ink_of(motion, joint.bodies)
        top = int(np.hypot(fx, fy).argmax())
        axes.axhline(0, color="#9aa3ab", linewidth=0.8, zorder=1)
        axes.axvline(0, color="#9aa3ab", linewidth=0.8, zorder=1)
        axes.plot(fx, fy, color=ink)
        axes.plot(fx[0], fy[0], "o", color=ink, markersize=5)
        axes.annotate(
            "",
            (fx[top], fy[top]),
            (0, 0),
            arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 1.1, "shrinkA": 0, "shrinkB": 0, "zorder": 1.5},
            zorder=1.5,
        )
        axes.set_title(
            f"{_within(heads[name], room)}\n{peaks[name]}" if is_long else f"{heads[name]}, {peaks[name]}",
            fontsize=TITLE, loc="left", color=ink,
        )  # fmt: skip
        axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.08)
        dress_plane(axes, ("fx", "fy"), "N", (6, 6))
        axes.xaxis.labelpad = axes.yaxis.labelpad = 1
    for axes in grid[len(shown) :]:
        axes.set_visible(False)
    return figure


def _spacing(count: int, gap: float, room: float) -> float:
    """Return the gap between ``count`` axes as a fraction of one, where both gap and room are in inches."""
    return count * gap / (room - (count - 1) * gap)


def _within(text: str, room: float) -> str:
    """Return as many letters of a text as there is room for."""
    return text if len(text) <= room else f"{text[: max(int(room) - 1, 1)]}…"


# Loads on the frame, of machines with bodies in different places along the normal: force, couple, centre of mass.

STILL = 1e-9
"""A centre of mass that moves by less (m) is at rest."""


def frame(motion: Motion) -> Figure:
    """Return the force of inertia (N), its couples (N m) and the way of the centre of mass (m).

    Couples are about axes in the plane.
    """
    over, shaken, vibration = horizon(motion), shaking(motion), motion.vibration
    assert vibration is not None
    assert shaken.mx is not None
    assert shaken.my is not None
    figure = page(
        motion.mechanism,
        "what the frame feels",
        f"inertia alone; moment about {shaken.about} in the report",
        insight_under(motion, "balance", "couple"),
    )
    force, couple, centre = rows(figure, 3)
    draw(
        force,
        over,
        "force",
        "N",
        [("x", shaken.fx, PALETTE[0]), ("y", shaken.fy, PALETTE[1])],
        floor=force_floor(motion),
    )
    lines = [("about x", shaken.mx, PALETTE[0]), ("about y", shaken.my, PALETTE[1])]
    draw(couple, over, "couple", "N m", lines, floor=couple_floor(motion))
    ways = [np.array(values) - np.mean(values) for values in (vibration.x, vibration.y)]
    lines = [("x", ways[0], PALETTE[0]), ("y", ways[1], PALETTE[1])]
    draw(centre, over, "centre of mass", "m", lines, floor=STILL)
    over.dress(centre)
    return figure
