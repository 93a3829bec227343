"""What the joints carry, the drivers give and the forces do: reactions, hodographs, forces."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure

from render.magnitudes import NOISE, force_scale, power_floor, torque_scale, without_noise
from render.plots.horizon import horizon
from render.plots.pages.rates import draw
from render.plots.style import INK, colour, page, rows
from shared.contract import Motion

PANELS = 12
"""Hodographs on one page; of more joints, those with the largest reactions."""


def reactions(motion: Motion) -> Figure:
    """Magnitude of every joint's reaction (N), its torque where it carries one (N m), and the drivers' effort."""
    over = horizon(motion)
    weak, slack = NOISE * force_scale(motion), NOISE * torque_scale(motion)
    forces = [(name, np.hypot(joint.fx, joint.fy), colour(i)) for i, (name, joint) in enumerate(motion.joints.items())]
    torques = [
        (name, np.asarray(joint.torque), colour(i))
        for i, (name, joint) in enumerate(motion.joints.items())
        if np.abs(joint.torque).max() > slack
    ]
    turning, pushing = [], []
    for i, (name, driver) in enumerate(motion.drivers.items()):
        (turning if "angle" in driver.kind else pushing).append((name, np.asarray(driver.effort), colour(i)))
    panels = [
        ("reaction force (N)", forces),
        ("reaction torque (N m)", torques),
        ("driver torque (N m)", turning),
        ("driver force (N)", pushing),
    ]
    panels = [(label, lines) for label, lines in panels if lines]
    figure = page(
        motion.mechanism,
        "what the joints carry",
        "magnitude of each joint's reaction, and what the driver must give",
    )
    for axes, (label, lines) in zip(rows(figure, len(panels)), panels, strict=True):
        draw(axes, over, label, lines, floor=slack if "N m" in label else weak)
    over.dress(figure.axes[-1])
    return figure


def forces(motion: Motion) -> Figure:
    """Signed size of every force (N) and torque (N m), what rigid contacts press with, and the power of forces (W)."""
    over = horizon(motion)
    weak, slack = NOISE * force_scale(motion), NOISE * torque_scale(motion)
    pushing, turning, giving = [], [], []
    for i, (name, force) in enumerate(motion.forces.items()):
        if force.effort is not None:
            (turning if force.measures == "angle" else pushing).append((name, np.asarray(force.effort), colour(i)))
        elif len(force.actions) == 1:
            sizes = np.hypot(force.actions[0].fx, force.actions[0].fy)
            pushing.append((f"|{name}|", sizes, colour(i)))
        giving.append((name, np.asarray(force.power), colour(i)))
    for i, (name, contact) in enumerate(motion.contacts.items(), len(motion.forces)):
        of_angle = "angle" in contact.kind or contact.kind == "one_way"
        (turning if of_angle else pushing).append((name, np.asarray(contact.normal), colour(i)))
    panels = [
        ("force (N)", pushing, weak),
        ("torque (N m)", turning, slack),
        ("power (W)", giving, power_floor(motion)),
    ]
    panels = [panel for panel in panels if panel[1]]
    figure = page(
        motion.mechanism,
        "what the forces do",
        "positive where it makes its length, angle or gap grow; power: what it gives to the motion",
    )
    for axes, (label, lines, floor) in zip(rows(figure, len(panels)), panels, strict=True):
        draw(axes, over, label, lines, floor=floor)
    over.dress(figure.axes[-1])
    return figure


def hodographs(motion: Motion) -> Figure:
    """The tip of each joint's reaction vector (N) over the motion, drawn from the origin; the dot is the start."""
    weak = NOISE * force_scale(motion)
    largest = sorted(
        motion.joints, key=lambda name: -float(np.hypot(motion.joints[name].fx, motion.joints[name].fy).max())
    )
    shown = [name for name in motion.joints if name in largest[:PANELS]]
    figure = page(
        motion.mechanism,
        "reactions by direction",
        "tip of the force on the joint's second body, world axes, in N; the dot marks the start, the arrow the largest",
    )
    columns = min(len(shown), max(3, math.ceil(math.sqrt(len(shown)))) if len(shown) != 4 else 2)
    grid = figure.subplots(math.ceil(len(shown) / columns), columns, squeeze=False).ravel()
    figure.subplots_adjust(left=0.07, right=0.975, top=0.83, bottom=0.085, wspace=0.22, hspace=0.34)
    for axes, name in zip(grid, shown, strict=False):
        joint = motion.joints[name]
        fx, fy = without_noise(np.asarray(joint.fx), weak), without_noise(np.asarray(joint.fy), weak)
        ink = colour(list(motion.joints).index(name))
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
            f"{name}: {joint.bodies[0]} on {joint.bodies[1]}, at most {math.hypot(fx[top], fy[top]):.3g} N",
            fontsize=10,
            loc="left",
            color=ink,
        )
        axes.set_aspect("equal", adjustable="datalim")
        axes.locator_params(nbins=6)
        axes.margins(0.08)
        axes.set_xlabel("fx (N)", labelpad=1)
        axes.set_ylabel("fy (N)", labelpad=1)
    for axes in grid[len(shown) :]:
        axes.set_visible(False)
    return figure
