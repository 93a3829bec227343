"""The page of energies, and what is rounding on any page: impacts, the balance, small machines."""

from __future__ import annotations

import msgspec
import numpy as np

from render import plots
from render.plots.pages.energy import powers, statement
from tests.render.plotted import MOTION, figure, overlaps, shown
from tools.models.motions import bouncing_ball


def test_an_impact_is_marked_in_joules_and_is_no_power() -> None:
    ball = bouncing_ball()
    given, rate = powers(ball)
    assert np.abs(given).max() == np.abs(rate).max() == 0.0  # a gradient over the samples would show tens of watts
    assert (
        statement(ball) == "nothing gives or takes power: the energy stays, but for 1 impact that takes 1.47 J at once"
    )
    drawn = figure("energy", ball)
    assert "\N{MINUS SIGN}1.47 J" in shown(drawn)
    assert overlaps(drawn) == []
    for plot in plots.plots_of(ball):
        figure(plot, ball).canvas.draw()


def test_the_balance_is_said_as_it_is() -> None:
    assert statement(MOTION) == "the drivers' power is the rate of the energy"
    dragged = msgspec.structs.replace(
        MOTION.drivers["motor"], power=[power + 0.3 for power in MOTION.drivers["motor"].power]
    )
    motion = msgspec.structs.replace(MOTION, drivers={"motor": dragged})
    assert "drivers and other forces (friction, dampers, loads; up to 300 mW) is the rate" in statement(motion)
    (line,) = [line for line in figure("energy", motion).axes[1].lines if line.get_label() == "other forces"]
    np.testing.assert_allclose(line.get_ydata(), -0.3, atol=1e-9)
    assert not [line for line in figure("energy", MOTION).axes[1].lines if line.get_label() == "other forces"]


def test_elastic_energy_counts_but_not_across_an_event() -> None:
    ball = bouncing_ball()
    stored = np.where(np.arange(len(ball.time)) < ball.time.index(ball.events[0].time) + 1, 0.0, 0.5)
    elastic = msgspec.structs.replace(ball.energy, potential=list(np.add(ball.energy.potential, stored)))
    _, rate = powers(msgspec.structs.replace(ball, energy=elastic))
    assert np.abs(rate).max() < 1e-9
    ramp = msgspec.structs.replace(
        ball.energy, potential=list(np.add(ball.energy.potential, np.multiply(3, ball.time)))
    )
    _, rate = powers(msgspec.structs.replace(ball, energy=ramp))
    np.testing.assert_allclose(rate, 3.0, rtol=1e-9)


def test_rounding_is_drawn_as_a_flat_line() -> None:
    """A balanced wheel at constant speed: energy, torque and reactions are constant but for the last digit."""
    random = np.random.default_rng(1)
    count = len(MOTION.time)

    def noise(size: float, value: float = 0.0) -> list[float]:
        return list(value + size * random.normal(size=count))

    crank = msgspec.structs.replace(MOTION.bodies["crank"], com=(0.0, 0.0), alpha=noise(1e-14))
    joint = msgspec.structs.replace(MOTION.joints["A"], fx=noise(1e-16), fy=noise(1e-15, 0.49), torque=noise(1e-17))
    motor = msgspec.structs.replace(MOTION.drivers["motor"], effort=noise(1e-17), power=noise(1e-16))
    energy = msgspec.structs.replace(MOTION.energy, kinetic=noise(1e-17, 0.02), potential=noise(1e-17))
    motion = msgspec.structs.replace(
        MOTION, bodies={"crank": crank}, joints={"A": joint}, drivers={"motor": motor}, energy=energy, points={}
    )
    for plot in ("energy", "bodies", "reactions"):
        for axes in figure(plot, motion).axes:
            low, high = axes.get_ylim()
            assert high - low > 1e-3, (plot, axes.get_ylabel())
            for line in axes.lines:
                values = np.asarray(line.get_ydata())
                if "angle / °" not in axes.get_ylabel() and len(values) == count:
                    assert np.ptp(values) == 0.0, (plot, line.get_label())
    assert [axes.get_ylabel() for axes in figure("reactions", motion).axes] == [
        "reaction force / mN",
        "driver torque / (N m)",
    ]


def test_small_machines_are_not_taken_for_noise() -> None:
    """Energies of nanojoules are drawn as they are: what is noise follows from the motion's own size."""
    small = {
        "bodies": {
            name: msgspec.structs.replace(body, mass=1e-8 * body.mass, inertia=1e-8 * body.inertia)
            for name, body in MOTION.bodies.items()
        },
        "joints": {
            name: msgspec.structs.replace(
                joint, fx=list(np.multiply(1e-8, joint.fx)), fy=list(np.multiply(1e-8, joint.fy))
            )
            for name, joint in MOTION.joints.items()
        },
        "drivers": {
            "motor": msgspec.structs.replace(
                MOTION.drivers["motor"],
                effort=list(np.multiply(1e-8, MOTION.drivers["motor"].effort)),
                power=list(np.multiply(1e-8, MOTION.drivers["motor"].power)),
            )
        },
        "energy": msgspec.structs.replace(
            MOTION.energy,
            kinetic=list(np.multiply(1e-8, MOTION.energy.kinetic)),
            potential=list(np.multiply(1e-8, MOTION.energy.potential)),
        ),
    }
    motion = msgspec.structs.replace(MOTION, **small)
    for plot in ("energy", "reactions"):
        for axes, other in zip(figure(plot, motion).axes, figure(plot, MOTION).axes, strict=True):
            for line, same in zip(axes.lines, other.lines, strict=True):
                if len(np.asarray(line.get_ydata())) == len(MOTION.time):
                    np.testing.assert_allclose(1e8 * np.asarray(line.get_ydata()), same.get_ydata(), atol=1e-12)
