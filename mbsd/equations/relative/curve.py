"""Curve constraint: marker j keeps a signed distance D from a curve on body i (0: on the curve).

u     foot of (x, y) on the curve;  t unit tangent, n = t_perp to its left, kappa = dt/ds . n
d     = n . ((x, y) - c(u))
F     = d - D,   grad F = n,   second derivatives -kappa / (1 - kappa d) t t^T

A disc of radius r on a terrain has D = r, a roller on its own pitch curve D = 0. Source: do Carmo, Differential
Geometry of Curves and Surfaces, 1976, ch. 1 (parallel curves). Where 1 - kappa d = 0 the foot is not unique.
"""

from __future__ import annotations

import math

from mbsd.equations.relative.curve_pieces import CX, CY, DDX, DDY, DISTANCE, DX, DY, find_foot
from mbsd.equations.relative.equation import FX, FXX, FXY, FY, FYY, F, X, Y, clear, equation


@equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers as in curve_pieces.py."""
    find_foot(numbers, relative)
    speed = math.sqrt(relative[DX] * relative[DX] + relative[DY] * relative[DY])
    tx = relative[DX] / speed
    ty = relative[DY] / speed
    kappa = (tx * relative[DDY] - ty * relative[DDX]) / (speed * speed)
    d = tx * (relative[Y] - relative[CY]) - ty * (relative[X] - relative[CX])
    bend = -kappa / (1.0 - kappa * d)
    clear(out)
    out[F] = d - numbers[DISTANCE]
    out[FX] = -ty
    out[FY] = tx
    out[FXX] = bend * tx * tx
    out[FXY] = bend * tx * ty
    out[FYY] = bend * ty * ty
