"""Machines of the page as they draw themselves."""

from __future__ import annotations

import math
from types import SimpleNamespace

from matplotlib.figure import Figure

from mbsd import Mechanism, constant_rate
from mbsd.cams import Lift, roller_cam


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(11.0, 6.0), layout="constrained")
    machines = (
        page.yoke, page.planetary, page.belt, page.steering, _cam(), page.geneva, page.hill, page.wire,
    )  # fmt: skip
    for m, ax in zip(machines, figure.subplots(2, 4).ravel(), strict=True):
        m.draw(ax=ax, frames=False, names=False)
        ax.set(xticks=[], yticks=[], xlabel="", ylabel="")
        ax.set_title("", loc="left")
        ax.set_title(m.name, loc="center")
    return {"joints.svg": figure}


def _cam() -> Mechanism:
    m = Mechanism("cam and roller")
    cam, follower = m.body("cam"), m.body("follower")
    lift = Lift.of((math.pi / 2, 0.02, "cycloidal"), (math.pi / 2, 0.02), (math.pi, 0.0, "3-4-5"))
    m.revolute("shaft", m.ground.origin, cam.origin)
    m.prismatic("guide", m.ground.at(0, 0.09, math.pi / 2), follower.at(0, 0.04, math.pi / 2))
    m.cam_roller("contact", cam.origin, follower.origin, roller_cam(lift, 0.04, 0.01))
    m.drive_angle("motor", cam, constant_rate(6.28, 1.0))
    m.start_near(follower=(0, 0.06, 0))
    return m
