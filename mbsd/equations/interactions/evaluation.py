"""Compiled evaluation of interactions: the relative state in, force and torque out.

d  = p_j - p_i;   u unit axis of marker i, n = u_perp;   x = u . d,  y = n . d,  a = theta_j - theta_i + offset
x' = u . d' + omega_i y,   y' = n . d' - omega_i x,   a' = omega_j - omega_i
on body j: F at marker j and T; on body i: -F at the same point and -T;   power = F . (x', y') + T a'
A state s of a force is the velocity of a body of its own along the x axis of ground, of mass 1: its load is s'.

    double f(const long *interaction, long n, double *given, double *state, double *out, double *switches, double t,
             const double *q, const double *v, const double *cos_sin, double *load)

Kernels call it by its address and give each array by its first number: handing over arrays as such takes longer than
all its work. So it is compiled only where a model has interactions.
"""

from __future__ import annotations

import math

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mbsd.compiling.jit import COMPILED, at_address, inlined
from mbsd.equations.interactions import law, switching
from mbsd.equations.laws import law_at
from mbsd.equations.relative.equation import OWN, POINTER, A, X, Y, evaluate_from

GEOMETRY = 7
"""Numbers of an interaction before its own."""
COLUMNS = 9
"""Number of columns of Loads.interaction."""
_WHOLE = types.CPointer(types.int64)
SIGNATURE = types.float64(
    _WHOLE, types.int64, POINTER, POINTER, POINTER, POINTER, types.float64, POINTER, POINTER, POINTER, POINTER
)


@at_address(SIGNATURE)
def apply(interaction, n, given, state, out, switches, t, q, v, cos_sin, load):
    """Add the generalised forces of n interactions to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    Tables are those of Loads. Returns their power (W).
    """
    power = 0.0
    for k in range(n):
        row = COLUMNS * k
        own = switching.WIDTH * (k + 1)
        first = interaction[row]
        second = interaction[row + 1]
        at = interaction[row + 3]
        i = 3 * first
        j = 3 * second
        c = cos_sin[2 * first]
        s = cos_sin[2 * first + 1]
        arm_ix = c * given[at] - s * given[at + 1]
        arm_iy = s * given[at] + c * given[at + 1]
        ux = c * given[at + 2] - s * given[at + 3]
        uy = s * given[at + 2] + c * given[at + 3]
        c = cos_sin[2 * second]
        s = cos_sin[2 * second + 1]
        arm_jx = c * given[at + 4] - s * given[at + 5]
        arm_jy = s * given[at + 4] + c * given[at + 5]
        dx = q[j] + arm_jx - q[i] - arm_ix
        dy = q[j + 1] + arm_jy - q[i + 1] - arm_iy
        omega = v[i + 2]
        vx = v[j] - v[j + 2] * arm_jy - v[i] + omega * arm_iy
        vy = v[j + 1] + v[j + 2] * arm_jx - v[i + 1] - omega * arm_ix
        x = ux * dx + uy * dy
        y = ux * dy - uy * dx
        state[X] = x
        state[Y] = y
        state[A] = q[j + 2] - q[i + 2] + given[at + 6]
        state[law.VX] = ux * vx + uy * vy + omega * y
        state[law.VY] = ux * vy - uy * vx - omega * x
        state[law.OMEGA] = v[j + 2] - omega
        crank = 3 * interaction[row + 6] + 2
        state[law.CRANK] = q[crank] - q[i + 2]
        state[law.CRANK_RATE] = v[crank] - omega
        away_x = q[crank - 2] - q[i] - arm_ix
        away_y = q[crank - 1] - q[i + 1] - arm_iy
        state[law.BODY_X] = ux * away_x + uy * away_y
        state[law.BODY_Y] = ux * away_y - uy * away_x
        state[law.TIME] = t
        state[law.LAW] = switches[own + switching.LAW_HERE]
        state[law.LAW_RATE] = switches[own + switching.LAW_RATE_HERE]
        side = switches[own + switching.KEPT] * switches[switching.HELD]
        state[law.SIDE] = side
        state[law.APPROACH] = switches[own + switching.APPROACHED]
        holding = 3 * interaction[row + 7]
        for s in range(interaction[row + 8]):
            state[law.OWN_STATE + s] = v[holding + 3 * s]
        out[law.SPEED] = 0.0
        out[law.SWITCH] = math.nan
        out[law.POWER] = 0.0
        # functions count their own numbers from OWN
        evaluate_from(interaction[row + 4], given, at + GEOMETRY - OWN, state, out)
        value = out[law.SWITCH]
        switches[own + switching.VALUE] = value
        switches[own + switching.ROUGH] = out[law.POWER]
        switches[own + switching.SPEED_HERE] = out[law.SPEED]
        if -side * value > switches[switching.NEAR]:
            switches[switching.BEYOND] = min(switches[switching.BEYOND], t)
        power += out[law.FX] * state[law.VX] + out[law.FY] * state[law.VY] + out[law.TORQUE] * state[law.OMEGA]
        fx = out[law.FX] * ux - out[law.FY] * uy
        fy = out[law.FX] * uy + out[law.FY] * ux
        load[j] += fx
        load[j + 1] += fy
        load[j + 2] += out[law.TORQUE] + arm_jx * fy - arm_jy * fx
        load[i] -= fx
        load[i + 1] -= fy
        load[i + 2] -= out[law.TORQUE] + (arm_ix + dx) * fy - (arm_iy + dy) * fx
        for s in range(interaction[row + 8]):
            load[holding + 3 * s] += out[law.RATE + s]
    return power


def address() -> int:
    """Return where the evaluation is; compiles it at first."""
    return apply.address if COMPILED else 0


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
        return apply(flat[0], count, *flat[1:5], t, *flat[5:])


@inlined
def apply_interactions(interaction, given, state, exchange, switch, laws, law_value, t, q, v, cos_sin, load):
    """Add the generalised forces of all interactions to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    The first five and ``law_value`` are those of Loads. Returns their power (W).
    """
    count = interaction.shape[0]
    for k in range(count):
        if interaction[k, 2] > 0:
            law_at(laws, interaction[k, 2], t, law_value)
            switch[k + 1, switching.LAW_HERE] = law_value[0]
            switch[k + 1, switching.LAW_RATE_HERE] = law_value[1]
    arrays = (interaction, given, state, exchange[1], switch, q, v, cos_sin, load)
    return _call(interaction[0, 5], count, t, arrays)
