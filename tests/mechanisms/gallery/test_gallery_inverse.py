"""The torque that makes a wished motion: virtual work, and there and back."""

from __future__ import annotations

import math

import numpy as np

from mbsd import table
from mechanisms.inverse_slider_crank import mechanism as inverse
from mechanisms.stages.solve import stage as solve_stage
from mechanisms.stages.solve.motion_file import to_motion
from render.report.loads import load_section
from shared.contract.quantity import written


def test_inverse_slider_crank_torque_makes_the_wished_motion() -> None:
    """Virtual work gives the torque, and a forward simulation under it gives the motion back."""
    p = inverse.Params()
    m = inverse.build(p)
    sol = inverse.motion(m, p)
    torque = sol.efforts["motor"]
    crank, slider = sol.body("crank"), sol.body("slider")
    np.testing.assert_allclose(slider.x, [inverse.place(p, t) for t in sol.t], atol=1e-9)
    power = np.gradient(sol.energy.total, sol.t, edge_order=2)
    assert np.abs(torque * crank.omega - power)[2:-2].max() < 2e-3 * np.abs(power).max()
    forward = m.with_efforts(wish=None, motor=table(sol.t, torque))
    forward.start_near(crank=math.degrees(crank.theta[0]), slider=(slider.x[0], 0, 0))
    again = forward.simulate(p.time, 360, tolerance=1e-10)
    assert np.abs(again.body("slider").x - slider.x).max() < 2e-3 * (p.far - p.near)


def test_the_line_and_the_report_tell_the_torque_and_not_the_driver_that_gives_nothing() -> None:
    p = inverse.Params()
    m = inverse.build(p)
    sol = inverse.motion(m, p)
    said = solve_stage._summary(sol)
    assert "wish" not in said
    assert said.endswith(f"motor up to {written(float(abs(sol.force('motor').effort).max()), 'N m')}")
    given = dict.fromkeys(("crank", "rod", "slider"), "mechanism")
    motion = to_motion(sol, None, "0" * 64, {}, given)  # pyright: ignore[reportArgumentType]
    lines = "\n".join(load_section(motion))
    assert "### Drivers" not in lines
    assert "| motor (torque) |" in lines
