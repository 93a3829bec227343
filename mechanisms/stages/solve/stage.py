"""The stage ``solve``: mechanism.py and masses of parts.json become data.json and skeleton.json."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from mechanisms.stages.loading import loading
from mechanisms.stages.loading.inputs import Inputs, observed, sources_state
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.skeleton_file import body_colours, main_material
from mechanisms.stages.solve.space.running import is_in_space, summary
from shared import contract
from shared.contract.quantity import counted, written
from shared.contract.skeleton import write_skeleton
from shared.stage import console
from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, Out
from shared.stage.stages import Stage, contract_sources, key_of, versions

if TYPE_CHECKING:
    from mbsd import Solution
    from mechanisms.stages.solve.masses import Source

NOISE = 1e-9
"""An effort below this part of the largest reaction is rounding."""
PACKAGES = ("numpy", "scipy", "numba", "llvmlite")
_MOTION = ("solving", "masses")
_STAGE = ("stage", *_MOTION, "motion_file", "skeleton_file")
SOURCES = [
    *(ROOT / "mechanisms" / "stages" / "solve" / f"{name}.py" for name in _STAGE),
    ROOT / "mechanisms" / "stages" / "solve" / "space",
    ROOT / "mechanisms" / "stages" / "loading" / "loading.py",
    *contract_sources("skeleton"),
]


def run(name: str, parts_are_outdated: bool = False) -> None:
    """Solve one mechanism unless its files already stand for the same inputs; parts need not be there.

    Parts of an older version count only if mechanism.py does not give all masses. Raises UserError.
    """
    out = Out(name)
    parts = parts_of(out)
    if parts is not None and parts_are_outdated:
        from mechanisms.stages.solve.masses import leaves_masses

        parts = parts if leaves_masses(solving.model_of(name)[0]) else None
    if _is_fresh(out, parts):
        console.say("solve", f"{name}: nothing to do")
        return
    from mechanisms.stages.solve.motion_file import to_motion
    from mechanisms.stages.solve.skeleton_file import skeleton_of

    def moved() -> tuple[Solution, contract.Motion | contract.Motion3]:
        solution, sources = solve(name, parts)
        if is_in_space(solution):
            from mechanisms.stages.solve.space.motion_file import to_motion3

            in_space, known = cast(Any, solution), cast(Any, sources)
            inks = body_colours(in_space.mechanism, parts)
            return solution, to_motion3(in_space, inks, versions(*PACKAGES), known)
        return solution, to_motion(solution, parts, "", versions(*PACKAGES), sources)

    (solution, motion), inputs = loading.recorded(name, moved)
    key = motion_key(parts, inputs)
    motion.provenance.inputs = key
    write_skeleton(out.skeleton, skeleton_of(solution, motion.provenance))
    contract.write_motion(out.motion, motion)
    Stage(out, "solve", key, [out.motion, out.skeleton]).record(inputs=inputs.names())
    console.say("solve", f"{name}: {_summary(solution)}")


def is_fresh(name: str) -> bool:
    """Return True if there is nothing to do. Raises UserError where parts.json cannot be read."""
    out = Out(name)
    return _is_fresh(out, parts_of(out))


def parts_of(out: Out) -> contract.Parts | None:
    """Return the parts that are there, if there are any."""
    return contract.read_parts(out.parts, out.name) if out.parts.is_file() else None


def _is_fresh(out: Out, parts: contract.Parts | None) -> bool:
    known = observed(Stage(out, "solve", "", []).notes().get("inputs"))
    return bool(known) and Stage(out, "solve", motion_key(parts, known), [out.motion, out.skeleton]).is_fresh()


def motion_key(parts: contract.Parts | None, inputs: Inputs) -> str:
    """Return the hash of all that the motion follows from.

    ``inputs``: what mechanism.py is made of, and what it reads.
    """
    masses = parts and {body: (solids.mass, solids.z, main_material(solids)) for body, solids in parts.bodies.items()}
    sources = sources_hash(*SOURCES), sources_state("mbsd"), sources_state("mbsd/drawing")
    return str(key_of(*sources, masses, versions(*PACKAGES), inputs.digest()))


def solve(name: str, parts: contract.Parts | None) -> tuple[Solution, dict[str, Source]]:
    """Build the mechanism, give it masses, say where those are from, and solve its motion.

    Raises UserError.

    Raises UserError. Also returns where the mass of each body is from.
    """
    from mechanisms.stages.solve.masses import give_masses

    m, module, p = solving.model_of(name)
    sources, sentences = give_masses(m, parts)
    for sentence in sentences:
        console.say("solve", f"{name}: {sentence}")
    return solving.motion_of(name, module, m, p), sources


def _summary(solution: Solution) -> str:
    efforts = summary(cast(Any, solution)) if is_in_space(solution) else _efforts(solution)
    return ", ".join(
        [
            f"{counted(len(solution.t), 'time')} over {solution.t[-1] - solution.t[0]:.4g} s",
            f"{counted(solution.mobility.dof, 'degree')} of freedom",
            f"closed to {solution.stats.position_residual:.0e} m",
            *efforts,
        ]
    )


def _efforts(solution: Solution) -> list[str]:
    """Return the largest efforts of drivers and of forces in their place, in words."""

    def drives(name: str) -> bool:
        force = solution.mechanism.forces[name]
        return force.kind.drives(force)

    efforts = {
        name: (driver.effort, driver.angular)
        for name in solution.mechanism.drivers
        for driver in [solution.driver(name)]
    }
    acting = {
        name: (force.effort, force.measures == "angle")
        for name, force in solution.forces.items()
        if force.effort is not None and drives(name)
    }
    idle = [name for name, (effort, _) in efforts.items() if not effort.any()]
    if idle:  # their place is taken by forces that were asked for, or nothing has mass
        efforts = {name: pair for name, pair in (efforts | acting).items() if name not in idle}
    loads = [float(solution.joint(joint).magnitude.max()) for joint in solution.mechanism.joints]
    rounding = NOISE * max(loads, default=0.0)
    peaks = []
    for name, (effort, angular) in efforts.items():
        peak, least = float(abs(effort).max()), rounding * (solution.packed.size if angular else 1.0)
        peaks.append(f"{name} up to {written(peak if peak > least else 0.0, 'N m' if angular else 'N')}")
    return peaks
