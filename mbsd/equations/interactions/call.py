"""How kernels reach the evaluation of interactions (apply.py): by an address, each array by its first number alone."""

from __future__ import annotations

import importlib

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mbsd.compiling.jit import COMPILED, inlined
from mbsd.equations.interactions.switching import LAW_HERE, LAW_RATE_HERE
from mbsd.equations.laws import law_at


def _apply():
    return importlib.import_module("mbsd.equations.interactions.apply").apply


def address() -> int:
    """Where the evaluation is; compiles it at first."""
    return _apply().address if COMPILED else 0


if COMPILED:

    @intrinsic
    def _call(typing, address, interaction, n, given, state, out, switches, t, q, v, cos_sin, load):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """Call it with contiguous arrays."""
        kinds = interaction, n, given, state, out, switches, t, q, v, cos_sin, load

        def code(context, builder, signature, arguments):
            where, *values = arguments
            for place, kind in enumerate(kinds):
                if isinstance(kind, types.Array):
                    values[place] = context.make_array(kind)(context, builder, values[place]).data
            double = cgutils.ir.DoubleType()
            function = cgutils.ir.FunctionType(double, [value.type for value in values])
            return builder.call(builder.inttoptr(where, function.as_pointer()), values)

        return types.float64(types.int64, *kinds), code

else:

    def _call(address, interaction, n, given, state, out, switches, t, q, v, cos_sin, load):
        """Call it with contiguous arrays."""
        flat = [part.reshape(-1) for part in (interaction, given, state, out, switches, q, v, cos_sin, load)]
        return _apply()(flat[0], n, *flat[1:5], t, *flat[5:])


@inlined
def apply_interactions(interaction, given, state, exchange, switch, laws, law, t, q, v, cos_sin, load):
    """Add the generalised forces of all interactions to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    The first five and ``law`` are those of Loads. Returns their power (W).
    """
    count = interaction.shape[0]
    for k in range(count):
        if interaction[k, 2] > 0:
            law_at(laws, interaction[k, 2], t, law)
            switch[k + 1, LAW_HERE] = law[0]
            switch[k + 1, LAW_RATE_HERE] = law[1]
    return _call(interaction[0, 5], interaction, count, given, state, exchange[1], switch, t, q, v, cos_sin, load)
