"""The doors by MuJoCo's rollout, Exudyn's ParameterVariation, and scipy one by one."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from benchmarks.simulations import DURATION, INERTIA, LENGTH, MASS


def mujoco(values: np.ndarray, step: float, threads: int = 1) -> np.ndarray:
    """(n,) final angles; RK4 at a fixed ``step`` (s), on ``threads`` of its rollout."""
    import mujoco as mj  # pyright: ignore[reportMissingImports]
    from mujoco import rollout  # pyright: ignore[reportMissingImports]

    own = MASS * LENGTH**2 / 12.0
    base = mj.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{step}" integrator="RK4" gravity="0 0 0"/><worldbody><body>
        <joint type="hinge" axis="0 0 1" stiffness="5" damping="10"/>
        <inertial pos="{LENGTH / 2} 0 0" mass="{MASS}" diaginertia="{own} {own} {own}"/></body></worldbody></mujoco>"""
    )
    models = []
    for stiffness, damping, preload in values:
        model = copy.copy(base)
        model.jnt_stiffness[0], model.dof_damping[0], model.qpos_spring[0] = stiffness, damping, -preload / stiffness
        models.append(model)
    start = np.zeros((len(values), mj.mj_stateSize(base, mj.mjtState.mjSTATE_FULLPHYSICS)))
    start[:, 1] = np.pi / 2
    data = [mj.MjData(base) for _ in range(threads)]
    states, _ = rollout.rollout(models, data, start, nstep=round(DURATION / step))
    return np.asarray(states)[:, -1, 1]


def exudyn(values: np.ndarray, step: float, threads: int = 1) -> np.ndarray:
    """(n,) final angles; Runge-Kutta of order 4 at a fixed ``step`` (s), one degree of freedom, no links."""
    from exudyn.processing import ParameterVariation  # pyright: ignore[reportMissingImports]

    _DOORS.clear()
    _DOORS.update(enumerate((*row, step) for row in values.tolist()))
    _, ends = ParameterVariation(
        _exudyn_case, {"case": list(_DOORS)}, useMultiProcessing=threads > 1, numberOfThreads=threads,
        showProgress=False,
    )  # fmt: skip
    return np.array(ends)


_DOORS: dict[int, tuple[float, float, float, float]] = {}
"""Stiffness, damping, preload and step by the case; worker processes begin as copies of this one."""


def _exudyn_case(parameters: dict[str, Any]) -> float:
    return _exudyn_door(*_DOORS[int(parameters["case"])])


def scipy(values: np.ndarray, tolerance: float) -> np.ndarray:
    """(n,) final angles; DOP853 of solve_ivp, whose right side is Python."""
    from scipy.integrate import solve_ivp

    def end(stiffness: float, damping: float, preload: float) -> float:
        def rates(_: float, y: np.ndarray) -> tuple[float, float]:
            return y[1], -(stiffness * y[0] + preload + damping * y[1]) / INERTIA

        run = solve_ivp(rates, (0.0, DURATION), (np.pi / 2, 0.0), "DOP853", rtol=tolerance, atol=tolerance)
        return float(run.y[0, -1])

    return np.array([end(*row) for row in values.tolist()])


def _exudyn_door(stiffness: float, damping: float, preload: float, step: float) -> float:
    import exudyn as exu  # pyright: ignore[reportMissingImports]
    from exudyn import itemInterface as items  # pyright: ignore[reportMissingImports]

    mbs: Any = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[np.pi / 2]))
    mbs.AddObject(items.Mass1D(nodeNumber=node, physicsMass=INERTIA))
    ground = mbs.AddNode(items.NodePointGround())
    ends = [mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=n, coordinate=0)) for n in (ground, node)]
    mbs.AddObject(
        items.CoordinateSpringDamper(
            markerNumbers=ends, stiffness=stiffness, damping=damping, offset=-preload / stiffness
        )
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = round(DURATION / step), DURATION
    settings.timeIntegration.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    return float(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates))
