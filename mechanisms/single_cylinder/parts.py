"""Automatic parts, with a flywheel that carries the shaft from one stroke of work to the next."""

from mechanisms.automatic import automatic
from mechanisms.single_cylinder.mechanism import Params, build
from shared.shapes.bodies import Bodies


def parts(p: Params) -> Bodies:
    """Return the bodies of :func:`automatic`, and the flywheel."""
    made = automatic(build(p))
    made.flywheel("crank")
    return made.solids()
