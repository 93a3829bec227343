"""The door of ``parts.py`` to automatic parts: what it may import of them."""

from mechanisms.stages.automatic.automatic import Automatic, automatic
from mechanisms.stages.automatic.layout.sizes import fit_at_scale
from mechanisms.stages.automatic.wheels.wheels import TUBE

__all__ = ["TUBE", "Automatic", "automatic", "fit_at_scale"]
