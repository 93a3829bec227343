"""Automatic solids of a mechanism, its mount, and the parts of a model at scale."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec

from mechanisms.stages.loading.wishes import wished_scale
from mechanisms.stages.solve.masses import bare_solution, depends_on_masses, leaves_masses
from mechanisms.stages.solve.solving import model_of
from mechanisms.stages.solve.space.running import is_in_space
from shared.contract import Mount, consistency, mounted
from shared.contract.parts import mounted_in_space
from shared.stage.errors import UserError
from shared.stage.paths import Out

if TYPE_CHECKING:
    from shared.contract import Mass
    from shared.contract.parts import Kind
    from shared.shapes.solid import Solid


# The solids that a motion or a model at a scale needs: those whose masses mechanism.py does not give.
#
# A sweep moves as its drivers say; its forces follow from the masses. A simulation of bodies whose masses mechanism.py
# does not give moves as the masses of their parts make it, so these parts are made first.


def needs_masses(name: str) -> bool:
    """Return True if mechanism ``name`` leaves a mass to its parts, or cannot be built to see that."""
    from mbsd import MechanismError

    try:
        return leaves_masses(model_of(name)[0])
    except (UserError, MechanismError):
        return True


def needs_machine(name: str) -> bool:
    """Return True if the motion of mechanism ``name`` may depend on the masses of its parts.

    It may, too, where that is not known without solving it: mechanism.py has a ``motion()``, or cannot be built.
    """
    from mbsd import MechanismError

    try:
        m, module, _ = model_of(name)
        return leaves_masses(m) and (hasattr(module, "motion") or m.mobility().dof > len(m.drivers))
    except (UserError, MechanismError):
        return True


# How a machine stands, from what ``parts()`` says, shot.py wishes and the model has.


def follows_gravity(bodies: Any, wish: Kind | None) -> bool:
    """Return True if solids by hand, which say nothing of it, stand because shot.py says so."""
    return getattr(bodies, "mount", None) is None and wish not in (None, "desk")


def mount_of(name: str, bodies: Any, wish: Kind | None) -> Mount:
    """Return the mount of what ``parts()`` returned.

    Solids by hand lie on a desk unless shot.py says otherwise.

    Raises UserError for one that parts() says and that cannot be.
    """
    if getattr(bodies, "mount", None) is None and getattr(bodies, "space", False):
        in_space: Any = model_of(name)[0]
        return mounted_in_space(name, in_space.gravity)
    if follows_gravity(bodies, wish):
        return mounted(model_of(name)[0].gravity or (0.0, 0.0), wish)
    said = getattr(bodies, "mount", None)
    if said is None:
        return Mount()
    where = f"{name}: parts(): mount is {said!r}"
    try:
        mount = msgspec.convert(dict(zip(("kind", "up"), said, strict=True)), Mount)
    except (msgspec.ValidationError, TypeError, ValueError) as error:
        raise UserError(f'{where}; write made.mount = "stand", (0.0, 1.0, 0.0) ({error})') from error
    consistency.refuse_wrong_mount(mount, where)
    return mount


# The solids of a mechanism without a parts.py: planned from mechanism.py and its motion alone.
#
# A simulated motion follows from the masses of the parts, and these follow from the motion: so it is solved again with
# the masses of the parts, and parts are made for that motion, until they stay as they are.
# Parts of a model at a scale move as the machine does: with its masses.

ROUNDS = 3
"""Rounds of parts made for a motion with the masses of those before."""
ALIKE = 1e-9
"""Masses that differ by less, relatively, are those of the same parts."""


def solids_of(name: str) -> dict[str, list[Solid]]:
    """Return every piece by body; what cannot be built is of glass, but for a model at a scale, which is printed.

    Raises UserError where the model cannot move, has no automatic parts, or its printed model cannot be built.
    """
    if is_in_space(model_of(name)[0]):
        from mechanisms.stages.automatic.space.machine import solids_in_space

        in_space: Any = bare_solution(name)
        return solids_in_space(in_space)
    from mechanisms.stages.automatic.automatic import automatic

    if wished_scale() is not None:
        solution = bare_solution(name, masses_of_machine(name))
        return automatic(solution.mechanism, solution=solution).solids()
    solution = bare_solution(name)
    solids = automatic(solution.mechanism, solution=solution).shown()
    if not depends_on_masses(name, solution):
        return solids
    masses = _masses(solids)
    for _ in range(ROUNDS):
        solution = bare_solution(name, masses)
        solids = automatic(solution.mechanism, solution=solution).shown()
        before, masses = masses, _masses(solids)
        if all(abs(masses[body].mass - before[body].mass) <= ALIKE * before[body].mass for body in before):
            break
    return solids


def masses_of_machine(name: str) -> dict[str, Mass]:
    """By body, those of the parts of the machine itself; none where there are none.

    The solids need not be there.
    """
    from shared.contract import Parts
    from shared.stage import jsonfile

    out = Out(name)
    if not out.parts.is_file():
        return {}
    bodies = jsonfile.read(out.parts, Parts).bodies
    return {body: described.mass for body, described in bodies.items() if body != "ground"}


def _masses(solids: dict[str, list[Solid]]) -> dict[str, Mass]:
    """Return masses of all pieces of each moving body together."""
    from mechanisms.stages.parts.meshes import combined, mass_of
    from shared.contract.materials import MATERIALS

    return {
        body: combined(mass_of(piece.shape.solids().vals()[0], MATERIALS[piece.material].density) for piece in pieces)
        for body, pieces in solids.items()
        if body != "ground"
    }
