"""Support constraint: a straight face on body j touches a convex outline on body i.

The face is the x axis of marker j, its outside (away from the outline) the side of its y axis. In the axes of marker i
the face's normal is (cos phi, sin phi), phi = a + pi / 2, and the outline reaches h(phi) in this direction:

F     = -x sin a + y cos a - h(a + pi / 2)

h is the outline's support function, 2 pi periodic, as quintic pieces. It touches at h n + h' n_perp; its radius of
curvature there is h + h''. Source: Gonzalez-Palacios, Angeles, Cam Synthesis, 1993, ch. 3.
"""

from __future__ import annotations

import math

from mbsd.equations.relative.equation import FA, FAA, FX, FXA, FY, FYA, OWN, A, F, X, Y, clear, equation


@equation
def residual(numbers, relative, out):
    """Fill F (m); numbers: count of pieces, then each one's begin (rad) and six coefficients.

    Coefficients go from the lowest power up.
    """
    a = relative[A]
    sine = math.sin(a)
    cosine = math.cos(a)
    count = int(numbers[OWN])
    table = OWN + 1
    begin = numbers[table]
    phi = a + 0.5 * math.pi - begin
    phi = begin + phi - 2.0 * math.pi * math.floor(phi / (2.0 * math.pi))
    low = 0
    high = count
    while high - low > 1:
        middle = (low + high) // 2
        if numbers[table + 7 * middle] <= phi:
            low = middle
        else:
            high = middle
    row = table + 7 * low
    s = phi - numbers[row]
    reach = 0.0
    slope = 0.0
    bend = 0.0
    for k in range(6):
        bend = bend * s + 2.0 * slope
        slope = slope * s + reach
        reach = reach * s + numbers[row + 6 - k]
    along = cosine * relative[X] + sine * relative[Y]
    across = cosine * relative[Y] - sine * relative[X]
    clear(out)
    out[F] = across - reach
    out[FX] = -sine
    out[FY] = cosine
    out[FA] = -along - slope
    out[FXA] = -cosine
    out[FYA] = -sine
    out[FAA] = -across - bend
