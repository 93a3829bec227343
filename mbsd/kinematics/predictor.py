"""Prediction of a pose: the quintic through the last two poses, velocities and accelerations."""

from __future__ import annotations

from mbsd.compiling.jit import inlined

LONGEST_STRETCH = 4.0
"""Beyond this ratio of step lengths the quintic is not trusted; the last (q, v, a) alone predicts."""


@inlined
def quintic_factors(t, k, time):
    """Return weights at ``time`` of the data of poses k - 1, k - 2: the difference of q, v and a of each.

    With s = ahead / h the quintic is linear in the six data, so its five factors are found once for all coordinates.
    """
    ahead = time - t[k - 1]
    h = t[k - 1] - t[k - 2] if k > 1 else 0.0
    from_q = 0.0
    from_v = ahead
    from_a = 0.5 * ahead * ahead
    earlier_v = 0.0
    earlier_a = 0.0
    if ahead < LONGEST_STRETCH * h:
        s = ahead / h
        cube = s * s * s
        from_q = -cube * (10.0 + s * (15.0 + 6.0 * s))
        p1 = -cube * (4.0 + s * (7.0 + 3.0 * s))
        p2 = -cube * (0.5 + s * (1.0 + 0.5 * s))
        from_v = h * (s + from_q - p1)
        from_a = h * h * (0.5 * s * s - 0.5 * from_q + p1 - p2)
        earlier_v = h * p1
        earlier_a = h * h * p2
    return from_q, from_v, from_a, earlier_v, earlier_a


@inlined
def quintic_value(factors, k, q, v, a, c):
    """Coordinate c of the pose that these factors tell, from poses k - 1 and k - 2 in q, v, a (T, 3 nb)."""
    from_q, from_v, from_a, earlier_v, earlier_a = factors
    last = k - 1
    before = max(k - 2, 0)
    return (
        q[last, c]
        + from_q * (q[before, c] - q[last, c])
        + from_v * v[last, c]
        + earlier_v * v[before, c]
        + from_a * a[last, c]
        + earlier_a * a[before, c]
    )
