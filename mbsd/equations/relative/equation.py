"""One-row equations between two bodies, called by address and compiled when a model uses them.

    void f(const double *numbers, const double *relative, double *out)

Whatever depends only on how two bodies stand to each other is a function F(x, y, a) of the relative pose: place (x, y)
of marker j in the axes of marker i (m) and the angle ``a`` of marker j against marker i (rad, never wrapped). The file
of an equation fills, by the indices below, F, its gradient and its second derivatives. Here they become rows of Phi, J
and gamma.

``numbers`` begins with the constants that the start pose decides, then come those of the joint, from ``OWN`` on. What
events change stands in ``relative``: ZERO, which an equation whose sliding is counted takes off like PHASE, and LAST
(mbsd/equations/system.py). Its places 4 to 13 are the equation's scratch.

The row of a constraint F(x, y, a) = f(t):

d     = p_j - p_i;   u = unit axis of marker i;   n = u_perp
x     = u . d,   y = n . d,   a = theta_j - theta_i + offset
J_x   = [-u, y - u . s_perp_i] on body i;    [u, u . s_perp_j] on body j
J_y   = [-n, -x - n . s_perp_i] on body i;   [n, n . s_perp_j] on body j
J_a   = [0, -1] on body i;                   [0, 1] on body j
gamma_x = -( u . (c_j - c_i) + 2 omega_i n . d' - omega_i^2 x ),   so that J_x a - gamma_x = x''
gamma_y = -( n . (c_j - c_i) - 2 omega_i u . d' - omega_i^2 y )

Phi   = F(x, y, a) - f(t)                                                      1 row
J     = F_x J_x + F_y J_y + F_a J_a
gamma = F_x gamma_x + F_y gamma_y - z'^T F_zz z' + f''
        z = (x, y, a),  x' = u . d' + omega_i y,  y' = n . d' - omega_i x,  a' = omega_j - omega_i

Source: chain rule; the relative coordinates are those of constraints.py.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mbsd.compiling.jit import COMPILED, at_address, inlined, lazy

X, Y, A, TURN = 0, 1, 2, 3
"""Places in ``relative``. TURN: how far the arm that carries both centres is turned against body i (rad)."""
F, FX, FY, FA, FXX, FXY, FXA, FYY, FYA, FAA = range(10)
"""Places in ``out``."""
OFFSET, PHASE, DIRECTION, WRAPS, OWN = range(5)
"""Places in ``numbers``: angle of marker j less that of marker i in their bodies; F = 0 stands for this much; direction
of the line of centres against the arm; 1 where no arm tells whole turns; the first number of the joint's own."""

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(POINTER, POINTER, POINTER)
_PYTHON: list[Callable] = []
"""Without the compiler an address is a place in this list."""


def equation(function: Callable) -> Any:
    """Decorator: an equation at an address."""
    if COMPILED:
        return at_address(SIGNATURE)(function)
    _PYTHON.append(function)
    return function


@inlined
def clear(out):
    """Set F and its derivatives to zero; an equation then fills those that are not."""
    for k in range(F, FAA + 1):
        out[k] = 0.0


def address_of(constraint: str) -> int:
    """Return where the equation of the constraint of this name is; compiles it at first."""
    made = importlib.import_module(f"mbsd.equations.relative.{constraint}").residual
    return made.address if COMPILED else _PYTHON.index(made)


if COMPILED:

    def _call(context, builder, where, data):
        pointer = cgutils.ir.DoubleType().as_pointer()
        function = cgutils.ir.FunctionType(cgutils.ir.VoidType(), [pointer] * 3)
        builder.call(builder.inttoptr(where, function.as_pointer()), data)
        return context.get_dummy_value()

    @intrinsic
    def evaluate(typing, address, numbers, relative, out):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """Call the equation at ``address`` with three contiguous arrays."""

        def code(context, builder, signature, arguments):
            where, *arrays = arguments
            data = [
                context.make_array(kind)(context, builder, array).data
                for kind, array in zip(signature.args[1:], arrays, strict=True)
            ]
            return _call(context, builder, where, data)

        return types.void(types.int64, numbers, relative, out), code

    @intrinsic
    def evaluate_from(typing, address, numbers, first, relative, out):  # pyright: ignore[reportUnusedParameter, reportRedeclaration]
        """Call the equation at ``address`` with pointers, of the numbers from ``first`` on."""

        def code(context, builder, signature, arguments):
            where, numbers, first, *others = arguments
            return _call(context, builder, where, [builder.gep(numbers, [first]), *others])

        return types.void(types.int64, numbers, types.int64, relative, out), code

else:

    def evaluate(address, numbers, relative, out):
        """Call the equation at ``address`` with three contiguous arrays."""
        _PYTHON[address](numbers, relative, out)

    def evaluate_from(address, numbers, first, relative, out):
        """Call the equation at ``address``, of the numbers from ``first`` on."""
        _PYTHON[address](numbers[first:], relative, out)


@inlined
def fill_row(out, ux, uy, x, y, arm_ix, arm_iy, arm_jx, arm_jy, jac):
    """Fill jac (6,) with the row of an equation by its gradient ``out``.

    (x, y) are in axes (ux, uy) of marker i.
    """
    gx = out[FX] * ux - out[FY] * uy
    gy = out[FX] * uy + out[FY] * ux
    jac[0] = -gx
    jac[1] = -gy
    jac[2] = out[FX] * y - out[FY] * x + gx * arm_iy - gy * arm_ix - out[FA]
    jac[3] = gx
    jac[4] = gy
    jac[5] = -gx * arm_jy + gy * arm_jx + out[FA]


@inlined
def gamma_of(out, ux, uy, x, y, vx, vy, cx, cy, omega, a_rate):
    """Return gamma of an equation without f''.

    d' = (vx, vy), c_j - c_i = (cx, cy), omega of body i, rate of a.
    """
    along = ux * vx + uy * vy
    across = ux * vy - uy * vx
    gamma_x = -(ux * cx + uy * cy + 2.0 * omega * across - omega * omega * x)
    gamma_y = -(ux * cy - uy * cx - 2.0 * omega * along - omega * omega * y)
    x_rate = along + omega * y
    y_rate = across - omega * x
    bend = (
        out[FXX] * x_rate * x_rate
        + out[FYY] * y_rate * y_rate
        + out[FAA] * a_rate * a_rate
        + 2.0 * (out[FXY] * x_rate * y_rate + out[FXA] * x_rate * a_rate + out[FYA] * y_rate * a_rate)
    )
    return out[FX] * gamma_x + out[FY] * gamma_y - bend


@lazy(None)
def relative_rows(system, q, drive, ws):
    """Fill residual and Jacobian of all constraints of relative pose; rows that are left out with zero."""
    for k in range(system.special.shape[0]):
        i = system.special[k, MARKER_I]
        j = system.special[k, MARKER_J]
        r = system.special[k, ROW]
        if system.special[k, ACTIVE] == 0:
            ws.phi[r] = 0.0
            for c in range(6):
                ws.jac[r, c] = 0.0
            continue
        at = system.special[k, AT]
        turned = q[3 * system.marker_body[i] + 2]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        x = ux * dx + uy * dy
        y = ux * dy - uy * dx
        relative = ws.relative[k]
        relative[X] = x
        relative[Y] = y
        relative[A] = q[3 * system.marker_body[j] + 2] - turned + system.numbers[at]
        relative[TURN] = q[3 * system.special[k, ARM] + 2] - turned
        out = ws.equation[k]
        evaluate(system.address[k], system.numbers[at:], relative, out)
        ws.phi[r] = out[F] - drive[system.special[k, MOTION], 0]
        fill_row(out, ux, uy, x, y, ws.arm[i, 0], ws.arm[i, 1], ws.arm[j, 0], ws.arm[j, 1], ws.jac[r])


@lazy(None)
def relative_gamma(system, v, ws, gamma):
    """Fill the acceleration right-hand side without f'', after relative_rows at the same pose."""
    for k in range(system.special.shape[0]):
        i = system.special[k, MARKER_I]
        j = system.special[k, MARKER_J]
        out = ws.equation[k]
        omega = v[3 * system.marker_body[i] + 2]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        x = ux * dx + uy * dy
        y = ux * dy - uy * dx
        vx = ws.velocity[j, 0] - ws.velocity[i, 0]
        vy = ws.velocity[j, 1] - ws.velocity[i, 1]
        cx = ws.convective[j, 0] - ws.convective[i, 0]
        cy = ws.convective[j, 1] - ws.convective[i, 1]
        a_rate = v[3 * system.marker_body[j] + 2] - omega
        gamma[system.special[k, ROW]] = gamma_of(out, ux, uy, x, y, vx, vy, cx, cy, omega, a_rate)


MARKER_I, MARKER_J, ROW, MOTION, AT, ARM, ACTIVE = range(7)
"""Columns of the table: markers, row, motion, first number, body of the arm, 0 while the row is left out."""
