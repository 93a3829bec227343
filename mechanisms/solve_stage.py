"""The stage ``solve``: mechanism.py and the masses of parts.json to data.json, and the skeleton to skeleton.json."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from mechanisms import loading
from mechanisms.recording import recording
from shared import console, contract
from shared.errors import UserError
from shared.files import sources_hash
from shared.inputs import Inputs, observed, sources_state
from shared.paths import ROOT, Out, mechanism_folder
from shared.skeleton import write_skeleton
from shared.stages import Stage, key_of, versions
from shared.suggestions import did_you_mean

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution

PACKAGES = ("numpy", "scipy", "numba", "llvmlite")
SOURCES = [
    *(ROOT / "mechanisms" / name for name in ("solve_stage.py", "skeleton_file.py")),
    *(ROOT / "shared" / name for name in ("contract.py", "jsonfile.py", "skeleton.py")),
]


def run(name: str) -> None:
    """Solve one mechanism unless its files already stand for the same inputs. Raises UserError."""
    out = Out(name)
    parts = contract.read_parts(out.parts, out.name)
    notes = Stage(out, "solve", "", []).notes()
    known = observed(notes.get("inputs"))
    if known and Stage(out, "solve", _key(parts, known), [out.motion, out.skeleton]).is_fresh():
        console.say("solve", f"{name}: nothing to do")
        return
    from mechanisms.loaded_files import loaded_inputs
    from mechanisms.skeleton_file import skeleton_of

    before = set(sys.modules)
    with recording() as recorder:
        solution = solve(name, parts)
        motion = to_motion(solution, parts, "", versions(*PACKAGES))
    loaded = loaded_inputs(mechanism_folder(name) / "mechanism.py", f"mechanisms.{name}", before)
    loaded.sources.pop("mbsd", None)  # it counts anyway
    inputs = loaded.joined(recorder.inputs())
    key = _key(parts, inputs)
    motion.provenance.inputs = key
    write_skeleton(out.skeleton, skeleton_of(solution, motion.provenance))
    contract.write_motion(out.motion, motion)
    Stage(out, "solve", key, [out.motion, out.skeleton]).done(inputs=inputs.names())
    console.say("solve", f"{name}: {_summary(solution)}")


def _key(parts: contract.Parts, inputs: Inputs) -> str:
    """Hash of all that the motion follows from; ``inputs``: what mechanism.py is made of, and what it reads."""
    masses = {body: (solids.mass, solids.z) for body, solids in parts.bodies.items()}
    return key_of(
        sources_hash(*SOURCES),
        sources_state("mbsd"),
        sources_state("mbsd/drawing"),
        masses,
        versions(*PACKAGES),
        inputs.digest(),
    )


def solve(name: str, parts: contract.Parts) -> Solution:
    """Build the mechanism, give it the masses of its parts and solve its motion.

    ``mechanism.py`` may define ``motion(m, p) -> Solution`` to say what is solved; without it one period of the
    driver is. Raises UserError.
    """
    from mbsd import MechanismError
    from mbsd.solution import Solution

    module = loading.load(name, "mechanism")
    p = loading.params(name)
    try:
        m = build(name, module, p)
        apply_masses(m, parts)
        with loading.author_code(name), _model_warnings_said(name):
            motion: Any = getattr(module, "motion", None)
            solution = motion(m, p) if motion else m.sweep()
    except MechanismError as error:
        raise UserError(str(error)) from error
    if not isinstance(solution, Solution):
        raise UserError(
            f"mechanisms/{name}/mechanism.py: motion() returned {_kind(solution)}; it must return a Solution, "
            "as m.sweep() and m.simulate() do"
        )
    _refuse_other(name, m, solution.mechanism)
    return solution


def build(name: str, module: Any, p: Any) -> Mechanism:
    """The model of ``build(p)`` in ``module``. Raises UserError unless it is a Mechanism called as its folder."""
    from mbsd import Mechanism

    with loading.author_code(name):
        m = module.build(p)
    file = f"mechanisms/{name}/mechanism.py"
    if not isinstance(m, Mechanism):
        raise UserError(f"{file}: build() returned {_kind(m)}, not a Mechanism; does it end with 'return m'?")
    if m.name != name:
        raise UserError(
            f"{file}: build() calls its mechanism '{m.name}', but the folder is {name}, and files are found by the "
            f'folder\'s name; write Mechanism("{name}")'
        )
    return m


def _refuse_other(name: str, m: Mechanism, solved: Mechanism) -> None:
    """What motion() solved may be a variant of the model, with the same name and bodies."""
    if solved is not m and (solved.name != name or set(solved.bodies) != set(m.bodies)):
        raise UserError(
            f"mechanisms/{name}/mechanism.py: motion() solved '{solved.name}' with the bodies "
            f"{', '.join(solved.bodies)}; solve the mechanism it is given, '{name}', or a variant with the same bodies"
        )


@contextmanager
def _model_warnings_said(name: str) -> Iterator[None]:
    """Say what the solver warns of in a line each, without the place in this file where it was called."""
    from mbsd import ModelWarning

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ModelWarning)
        try:
            yield
        finally:
            for warning in caught:
                if issubclass(warning.category, ModelWarning):
                    console.warn("solve", str(warning.message))
    for warning in caught:
        if not issubclass(warning.category, ModelWarning):
            warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)


def _kind(value: object) -> str:
    return "None" if value is None else f"a {type(value).__name__}"


def apply_masses(m: Mechanism, parts: contract.Parts) -> None:
    """Masses from CAD, by body name. Raises UserError if names do not match."""
    bodies = set(m.bodies) - {"ground"}
    solids = set(parts.bodies) - {"ground"}
    for missing, where, there in ((bodies - solids, "parts.py", solids), (solids - bodies, "mechanism.py", bodies)):
        if missing:
            raise UserError(
                f"{m.name}: {where} has no body '{min(missing)}'; it has: {', '.join(sorted(there)) or 'none'}"
                f"{did_you_mean(min(missing), there) or '.'} mechanism.py and parts.py must name the same bodies"
            )
    for name in bodies:
        mass = parts.bodies[name].mass
        m.set_mass(name, mass.mass, mass.com, mass.inertia)


def to_motion(solution: Solution, parts: contract.Parts, inputs: str, packages: dict[str, str]) -> contract.Motion:
    """The solution as the contract has it: plain lists, author's frames."""
    import mbsd

    m = solution.mechanism
    frame_fields = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")
    bodies = {
        name: contract.BodyMotion(
            **{field: getattr(solution.body(name), field).tolist() for field in frame_fields},
            z=parts.bodies[name].z,
            mass=body.mass,
            com=body.com,
            inertia=body.inertia,
        )
        for name, body in m.bodies.items()
        if name != "ground"
    }
    joints = {
        name: contract.JointMotion(
            kind=joint.kind.name,
            bodies=joint.bodies,
            **{field: getattr(solution.joint(name), field).tolist() for field in ("x", "y", "fx", "fy", "torque")},
        )
        for name, joint in m.joints.items()
    }
    drivers = {
        name: contract.DriverMotion(
            kind=driver.kind.name.removeprefix("drive_"),
            **{field: getattr(solution.driver(name), field).tolist() for field in ("value", "effort", "power")},
        )
        for name, driver in m.drivers.items()
    }
    points = {
        name: contract.PointMotion(
            body=marker.body.name,
            **{field: getattr(solution.point(name), field).tolist() for field in ("x", "y", "vx", "vy", "ax", "ay")},
        )
        for name, marker in m.traces.items()
    }
    stats = solution.stats
    return contract.Motion(
        mechanism=m.name,
        provenance=contract.Provenance(inputs=inputs, versions=packages | {"mbsd": mbsd.__version__}),
        gravity=(float(m.gravity[0]), float(m.gravity[1])) if m.gravity else (0.0, 0.0),
        period=solution.period,
        time=solution.t.tolist(),
        bodies=bodies,
        joints=joints,
        drivers=drivers,
        points=points,
        energy=contract.Energy(kinetic=solution.energy.kinetic.tolist(), potential=solution.energy.potential.tolist()),
        events=[
            contract.EventMark(time=event.time, name=event.name, what=event.what, energy=event.energy)
            for event in solution.events
        ],
        diagnostics=contract.Diagnostics(
            position_residual=stats.position_residual,
            velocity_residual=stats.velocity_residual,
            acceleration_residual=stats.acceleration_residual,
            power_residual=stats.power_residual,
            dof=solution.mobility.dof,
            redundant=list(solution.mobility.redundant),
            singularity_margin=solution.singularity_margin.tolist(),
        ),
    )


def _summary(solution: Solution) -> str:
    peaks = [
        f"{name} up to {abs(driver.effort).max():.3g} {'N m' if driver.angular else 'N'}"
        for name in solution.mechanism.drivers
        for driver in [solution.driver(name)]
    ]
    return ", ".join(
        [
            f"{len(solution.t)} times over {solution.t[-1] - solution.t[0]:.4g} s",
            f"{solution.mobility.dof} degree{'s' * (solution.mobility.dof != 1)} of freedom",
            f"closed to {solution.stats.position_residual:.0e} m",
            *peaks,
        ]
    )
