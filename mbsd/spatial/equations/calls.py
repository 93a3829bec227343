"""Forces by functions at an address: laws of mbsd between two frames, and functions of the user.

A function gets the time, place (m), Euler parameters, velocity and angular velocity of its frames in the world, then
its numbers. It gives force and moment at each frame's place, in the world, and of a law the energy it holds:

    inputs     7 f places, 6 f rates, numbers        outputs    6 f, energy (J)
"""

from __future__ import annotations

import math

from mbsd.compiling.callback import SIGNATURE, call
from mbsd.compiling.jit import at_address, inlined, kernel, lazy
from mbsd.spatial.equations.vectors import carry_vectors, rotate_bodies

law = at_address(SIGNATURE)
"""Decorates a law: f(t, inputs, outputs)."""
NUMBERS = 26
"""Where the numbers of a law between two frames begin."""


@lazy(float)
def apply_calls(system, t, q, v, ws, load):
    """Add the forces of all functions to load (3 + 6 n,) at q, v in the world and t (s); returns their power (W).

    What they gave stays in ws.outputs.
    """
    power = 0.0
    for n in range(system.call.shape[0]):
        first = system.call[n, 1]
        count = system.call[n, 2]
        inputs = ws.inputs[system.call[n, 3] :]
        outputs = ws.outputs[n]
        for i in range(count):
            p = system.frame_place[first + i]
            b = system.arm_body[p]
            o = system.frame_turn[first + i]
            at = 7 * i
            rate = 7 * count + 6 * i
            for k in range(3):
                inputs[at + k] = ws.place[p, k]
            for k in range(4):
                inputs[at + 3 + k] = o[k]
            for k in range(6):
                inputs[rate + k] = 0.0
            if b > 0:
                e = q[7 * b - 1 : 7 * b + 3]
                size = 1.0 / math.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3])
                inputs[at + 3] = size * (e[0] * o[0] - e[1] * o[1] - e[2] * o[2] - e[3] * o[3])
                inputs[at + 4] = size * (e[0] * o[1] + e[1] * o[0] + e[2] * o[3] - e[3] * o[2])
                inputs[at + 5] = size * (e[0] * o[2] + e[2] * o[0] + e[3] * o[1] - e[1] * o[3])
                inputs[at + 6] = size * (e[0] * o[3] + e[3] * o[0] + e[1] * o[2] - e[2] * o[1])
                w = v[6 * b : 6 * b + 3]
                s = ws.arm[p]
                inputs[rate] = v[6 * b - 3] + w[1] * s[2] - w[2] * s[1]
                inputs[rate + 1] = v[6 * b - 2] + w[2] * s[0] - w[0] * s[2]
                inputs[rate + 2] = v[6 * b - 1] + w[0] * s[1] - w[1] * s[0]
                for k in range(3):
                    inputs[rate + 3 + k] = w[k]
        outputs[6 * count] = 0.0
        call(system.call[n, 0], t, inputs, outputs)  # pyright: ignore[reportCallIssue]
        for i in range(count):
            p = system.frame_place[first + i]
            b = system.arm_body[p]
            if b > 0:
                f = outputs[6 * i : 6 * i + 6]
                s = ws.arm[p]
                c = 6 * b - 3
                for k in range(6):
                    power += f[k] * inputs[7 * count + 6 * i + k]
                    load[c + k] += f[k]
                load[c + 3] += s[1] * f[2] - s[2] * f[1]
                load[c + 4] += s[2] * f[0] - s[0] * f[2]
                load[c + 5] += s[0] * f[1] - s[1] * f[0]
    return power


@kernel
def tabulate_calls(system, times, q, v, ws, out):
    """Fill out (T, calls, outputs) with what all functions give along a motion, v in the world."""
    for k in range(times.shape[0]):
        rotate_bodies(system, q[k], ws)
        carry_vectors(system, q[k], ws)
        apply_calls(system, times[k], q[k], v[k], ws, ws.load)
        for n in range(out.shape[1]):
            for c in range(out.shape[2]):
                out[k, n, c] = ws.outputs[n, c]


@inlined
def z_axis(inputs, at):
    """Return the z axis of the frame whose Euler parameters stand from ``at`` on, in the world."""
    w = inputs[at]
    x = inputs[at + 1]
    y = inputs[at + 2]
    z = inputs[at + 3]
    return 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)


@inlined
def to_frame(inputs, at, x, y, z):
    """Return a vector of the world in the axes of the frame whose Euler parameters stand from ``at`` on."""
    a = inputs[at]
    b = -inputs[at + 1]
    c = -inputs[at + 2]
    d = -inputs[at + 3]
    p = c * z - d * y + a * x
    q = d * x - b * z + a * y
    r = b * y - c * x + a * z
    return x + 2.0 * (c * r - d * q), y + 2.0 * (d * p - b * r), z + 2.0 * (b * q - c * p)


@inlined
def to_world(inputs, at, x, y, z):
    """Return a vector of the frame whose Euler parameters stand from ``at`` on in the world."""
    a = inputs[at]
    b = inputs[at + 1]
    c = inputs[at + 2]
    d = inputs[at + 3]
    p = c * z - d * y + a * x
    q = d * x - b * z + a * y
    r = b * y - c * x + a * z
    return x + 2.0 * (c * r - d * q), y + 2.0 * (d * p - b * r), z + 2.0 * (b * q - c * p)


@inlined
def push_pair(inputs, outputs, fx, fy, fz, rx, ry, rz):
    """Put out a force (world) on the second body at r from its place, and its opposite on the first."""
    dx = inputs[7] - inputs[0] + rx
    dy = inputs[8] - inputs[1] + ry
    dz = inputs[9] - inputs[2] + rz
    outputs[0] = -fx
    outputs[1] = -fy
    outputs[2] = -fz
    outputs[3] = -(dy * fz - dz * fy)
    outputs[4] = -(dz * fx - dx * fz)
    outputs[5] = -(dx * fy - dy * fx)
    outputs[6] = fx
    outputs[7] = fy
    outputs[8] = fz
    outputs[9] = ry * fz - rz * fy
    outputs[10] = rz * fx - rx * fz
    outputs[11] = rx * fy - ry * fx
