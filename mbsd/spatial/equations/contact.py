"""Contact by penalty of a round body with a plane or a height field, and tyres.

The body is a torus about the z axis of frame j: a ring of radius R with a tube of radius r; R = 0 is a ball or a
point, r = 0 a disc. The surface is the plane x, y of frame i, or a height z = h(x, y) over it, with matter below.

    u = (n - (n . a) a) / |..|        a: axis of the ring,  n: normal of the surface at the foot
    gap = n . (P - foot) - R sqrt(1 - (n . a)^2) - r
    N = k d^p (1 + c d'),  d = -gap > 0, never below 0        Hunt and Crossley
    T = -mu N tanh(s / s_0)                                   against the sliding velocity, of size s

They act at P + rho, rho = -(R u + (r - d) n): on the surface, over the lowest point.

The energy of N is k d^(p + 1) / (p + 1). A tyre has N = k d + c d' instead, and

    s_x = B_x kappa,  s_y = B_y tan alpha        kappa = -(v_x at the foot) / v,  tan alpha = (v_y at the foot) / v
    F = N D sin(C atan(s - E (s - atan s)))      s = |(s_x, s_y)|,  v = sqrt(v_x^2 + v_0^2) of the hub along its way
    F_x = F s_x / s,   F_y = -F s_y / s

Source: Hunt, Crossley 1975, J. Appl. Mech. 42, 440; Pacejka 2012, Tire and Vehicle Dynamics, ch. 4 (similar slips).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined
from mbsd.spatial.equations.calls import NUMBERS, law, push_pair, to_frame, to_world, z_axis

RING, TUBE, STIFFNESS, EXPONENT, DAMPING, FRICTION, SLIP_SPEED = range(NUMBERS, NUMBERS + 7)
GRIP, SLOPE, SIDE_SLOPE, SHAPE, CURVATURE, STANDSTILL = range(NUMBERS + 7, NUMBERS + 13)
COLUMNS, ROWS, FIRST_X, FIRST_Y, STEP_X, STEP_Y, HEIGHTS = range(NUMBERS + 13, NUMBERS + 20)
"""Numbers of a height field; 0 columns: a plane."""
LOOKS = 30
FLAT = 1e-12


@inlined
def _weights(x):
    """Return weights of four neighbours, and of the slope, at the part x between the middle ones."""
    return (
        0.5 * x * (x * (2.0 - x) - 1.0),
        0.5 * (x * x * (3.0 * x - 5.0) + 2.0),
        0.5 * x * (x * (4.0 - 3.0 * x) + 1.0),
        0.5 * x * x * (x - 1.0),
        0.5 * (x * (4.0 - 3.0 * x) - 1.0),
        0.5 * x * (9.0 * x - 10.0),
        0.5 * (x * (8.0 - 9.0 * x) + 1.0),
        0.5 * x * (3.0 * x - 2.0),
    )


@inlined
def _height(inputs, x, y):
    """Return height and slopes at x, y (m): cubic pieces through neighbours, level lines beyond the edges."""
    columns = int(inputs[COLUMNS])
    rows = int(inputs[ROWS])
    px = min(max((x - inputs[FIRST_X]) / inputs[STEP_X], 0.0), columns - 1.0)
    py = min(max((y - inputs[FIRST_Y]) / inputs[STEP_Y], 0.0), rows - 1.0)
    i = min(int(px), columns - 2)
    j = min(int(py), rows - 2)
    a0, a1, a2, a3, s0, s1, s2, s3 = _weights(px - i)
    b0, b1, b2, b3, t0, t1, t2, t3 = _weights(py - j)
    z = zx = zy = 0.0
    for k in range(4):
        row = HEIGHTS + columns * min(max(j - 1 + k, 0), rows - 1)
        h0 = inputs[row + max(i - 1, 0)]
        h1 = inputs[row + i]
        h2 = inputs[row + i + 1]
        h3 = inputs[row + min(i + 2, columns - 1)]
        value = a0 * h0 + a1 * h1 + a2 * h2 + a3 * h3
        slope = s0 * h0 + s1 * h1 + s2 * h2 + s3 * h3
        weight = b0 if k == 0 else b1 if k == 1 else b2 if k == 2 else b3
        z += weight * value
        zx += weight * slope
        zy += (t0 if k == 0 else t1 if k == 1 else t2 if k == 2 else t3) * value
    beyond_x = x < inputs[FIRST_X] or x > inputs[FIRST_X] + inputs[STEP_X] * (columns - 1)
    beyond_y = y < inputs[FIRST_Y] or y > inputs[FIRST_Y] + inputs[STEP_Y] * (rows - 1)
    return z, 0.0 if beyond_x else zx / inputs[STEP_X], 0.0 if beyond_y else zy / inputs[STEP_Y]


@inlined
def _foot(inputs):
    """Return the distance of place j from the surface, and the normal there in the world."""
    x, y, z = to_frame(inputs, 3, inputs[7] - inputs[0], inputs[8] - inputs[1], inputs[9] - inputs[2])
    if inputs[COLUMNS] == 0.0:
        n1, n2, n3 = z_axis(inputs, 3)
        return z, n1, n2, n3
    fx = x
    fy = y
    far = 0.0
    n1 = n2 = 0.0
    n3 = 1.0
    for _ in range(LOOKS):
        h, hx, hy = _height(inputs, fx, fy)
        size = 1.0 / math.sqrt(1.0 + hx * hx + hy * hy)
        n1 = -hx * size
        n2 = -hy * size
        n3 = size
        far = n1 * (x - fx) + n2 * (y - fy) + n3 * (z - h)
        gx = x - far * n1
        gy = y - far * n2
        moved = abs(gx - fx) + abs(gy - fy)
        fx = gx
        fy = gy
        if moved < FLAT * (abs(x) + abs(y) + inputs[STEP_X]):
            break
    w1, w2, w3 = to_world(inputs, 3, n1, n2, n3)
    return far, w1, w2, w3


@inlined
def _lowest(inputs):
    """Return depth (m), normal, and rho from place j to the foot over its lowest point, in the world."""
    far, n1, n2, n3 = _foot(inputs)
    a1, a2, a3 = z_axis(inputs, 10)
    k = n1 * a1 + n2 * a2 + n3 * a3
    u1 = n1 - k * a1
    u2 = n2 - k * a2
    u3 = n3 - k * a3
    size = math.sqrt(u1 * u1 + u2 * u2 + u3 * u3)
    ring = inputs[RING] / max(size, FLAT)
    tube = inputs[TUBE]
    depth = inputs[RING] * size + tube - far
    tube -= depth
    return depth, n1, n2, n3, -(ring * u1 + tube * n1), -(ring * u2 + tube * n2), -(ring * u3 + tube * n3)


@inlined
def _sliding(inputs, rx, ry, rz):
    """Return the velocity at rho from place j of the second body against the first, in the world."""
    dx = inputs[7] - inputs[0] + rx
    dy = inputs[8] - inputs[1] + ry
    dz = inputs[9] - inputs[2] + rz
    return (
        inputs[20] + inputs[24] * rz - inputs[25] * ry - inputs[14] - (inputs[18] * dz - inputs[19] * dy),
        inputs[21] + inputs[25] * rx - inputs[23] * rz - inputs[15] - (inputs[19] * dx - inputs[17] * dz),
        inputs[22] + inputs[23] * ry - inputs[24] * rx - inputs[16] - (inputs[17] * dy - inputs[18] * dx),
    )


@law
def contact(t, inputs, outputs):
    """Put out wrenches of a contact by penalty."""
    for k in range(13):
        outputs[k] = 0.0
    depth, n1, n2, n3, rx, ry, rz = _lowest(inputs)
    if depth > 0.0:
        v1, v2, v3 = _sliding(inputs, rx, ry, rz)
        apart = v1 * n1 + v2 * n2 + v3 * n3
        elastic = inputs[STIFFNESS] * depth ** inputs[EXPONENT]
        normal = max(elastic * (1.0 - inputs[DAMPING] * apart), 0.0)
        v1 -= apart * n1
        v2 -= apart * n2
        v3 -= apart * n3
        slip = math.sqrt(v1 * v1 + v2 * v2 + v3 * v3)
        drag = 0.0
        if inputs[FRICTION] > 0.0:
            low = inputs[SLIP_SPEED]
            drag = inputs[FRICTION] * normal * (math.tanh(slip / low) / slip if slip > 1e-9 * low else 1.0 / low)
        push_pair(
            inputs, outputs, normal * n1 - drag * v1, normal * n2 - drag * v2, normal * n3 - drag * v3, rx, ry, rz
        )
        outputs[12] = elastic * depth / (inputs[EXPONENT] + 1.0)


@law
def tyre(t, inputs, outputs):
    """Put out wrenches of a tyre."""
    for k in range(13):
        outputs[k] = 0.0
    depth, n1, n2, n3, rx, ry, rz = _lowest(inputs)
    if depth > 0.0:
        v1, v2, v3 = _sliding(inputs, rx, ry, rz)
        apart = v1 * n1 + v2 * n2 + v3 * n3
        normal = max(inputs[STIFFNESS] * depth - inputs[DAMPING] * apart, 0.0)
        a1, a2, a3 = z_axis(inputs, 10)
        x1 = a2 * n3 - a3 * n2  # forward: axis x normal
        x2 = a3 * n1 - a1 * n3
        x3 = a1 * n2 - a2 * n1
        size = 1.0 / max(math.sqrt(x1 * x1 + x2 * x2 + x3 * x3), FLAT)
        x1 *= size
        x2 *= size
        x3 *= size
        y1 = n2 * x3 - n3 * x2
        y2 = n3 * x1 - n1 * x3
        y3 = n1 * x2 - n2 * x1
        h1, h2, h3 = _sliding(inputs, 0.0, 0.0, 0.0)
        hub = h1 * x1 + h2 * x2 + h3 * x3
        speed = math.sqrt(hub * hub + inputs[STANDSTILL] ** 2)
        along = -inputs[SLOPE] * (v1 * x1 + v2 * x2 + v3 * x3) / speed
        across = inputs[SIDE_SLOPE] * (v1 * y1 + v2 * y2 + v3 * y3) / speed
        slip = math.sqrt(along * along + across * across)
        bent = slip - inputs[CURVATURE] * (slip - math.atan(slip))
        force = normal * inputs[GRIP] * math.sin(inputs[SHAPE] * math.atan(bent))
        part = force / slip if slip > 1e-12 else normal * inputs[GRIP] * inputs[SHAPE]
        fx = part * along
        fy = -part * across
        push_pair(
            inputs, outputs, normal * n1 + fx * x1 + fy * y1, normal * n2 + fx * x2 + fy * y2,
            normal * n3 + fx * x3 + fy * y3, rx, ry, rz,
        )  # fmt: skip
        outputs[12] = 0.5 * inputs[STIFFNESS] * depth * depth
