"""Roots between two places, by Chandrupatla 1997, Adv. Eng. Softw. 28, 145: quadratic steps inside a bracket.

a, b     ends of the bracket, f(a) f(b) <= 0, a the last place that was looked at
c        the place before; xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb)
part     the next place is a + part (b - a): by the parabola through a, b, c where phi^2 < xi and
         (1 - phi)^2 < 1 - xi, else the middle
"""

from __future__ import annotations

from mbsd.compiling.jit import internal


@internal
def next_part(a, fa, b, fb, c, fc):
    """Return where between a and b the root is looked for next, as a part of the way from a to b."""
    if fb == fc or fa == fc:
        return 0.5
    xi = (a - b) / (c - b)
    phi = (fa - fb) / (fc - fb)
    if phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi:
        return fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    return 0.5


@internal
def narrowed(a, fa, b, fb, x, f):
    """Return the next a, fa, b, fb, c, fc, after f was evaluated at x between a and b."""
    if (f > 0.0) == (fa > 0.0):
        return x, f, b, fb, a, fa
    return x, f, a, fa, b, fb
