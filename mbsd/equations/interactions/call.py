"""Call of the evaluation of interactions (apply.py): by an address, each array by its first number."""

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
    """Return where the evaluation is; compiles it at first."""
    return _apply().address if COMPILED else 0


if COMPILED:

    @intrinsic
    def _call(typing, address, count, t, arrays):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """Call it with a tuple of contiguous arrays, in the order of ``apply``."""

        def code(context, builder, signature, arguments):
            where, number, time, values = arguments
            data = []
            for index, kind in enumerate(signature.args[3]):
                array = context.make_array(kind)(context, builder, builder.extract_value(values, index))
                data.append(array.data)
            given = [data[0], number, *data[1:5], time, *data[5:]]
            double = cgutils.ir.DoubleType()
            function = cgutils.ir.FunctionType(double, [value.type for value in given])
            return builder.call(builder.inttoptr(where, function.as_pointer()), given)

        return types.float64(types.int64, types.int64, types.float64, arrays), code

else:

    def _call(address, count, t, arrays):
        """Call it with a tuple of contiguous arrays, in the order of ``apply``."""
        flat = [part.reshape(-1) for part in arrays]
        return _apply()(flat[0], count, *flat[1:5], t, *flat[5:])


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
    arrays = (interaction, given, state, exchange[1], switch, q, v, cos_sin, load)
    return _call(interaction[0, 5], count, t, arrays)
