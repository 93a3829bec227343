"""Rolling without slip of a disc of radius r about marker j on the left of a curve on body i.

s     arc length of the foot of (x, y);  beta angle of the tangent t there;  n = t_perp;  kappa = d beta / ds
d     = n . ((x, y) - c),   w = 1 - kappa d,   ds = t / w . d(x, y)
F     = s - r (beta - a) - c,   with G(s) = s - r beta:  G' = 1 - r kappa,  G'' = -r kappa'

grad F = G' t / w,   F_a = r
second derivatives of s:  kappa / w^2 (n t^T + t n^T) + kappa' d / w^3 t t^T

The centre moves (1 - r kappa) ds while the disc turns by da: on the curve the point of contact stands still. On a
closed curve F is reduced to its value nearest to zero, as it changes by length - 2 pi r over a round.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal
from mbsd.equations.relative.curve_pieces import (
    ARC,
    CLOSED,
    COUNT,
    CX,
    CY,
    DDDX,
    DDDY,
    DDX,
    DDY,
    DX,
    DY,
    LENGTH,
    PIECE,
    RADIUS,
    SPAN,
    TABLE,
    TANGENT,
    TURNING,
    WIDTH,
    U,
    find_foot,
    place_on,
)
from mbsd.equations.relative.equation import (
    FA,
    FX,
    FXX,
    FXY,
    FY,
    FYY,
    PHASE,
    A,
    F,
    X,
    Y,
    clear,
    equation,
)
from mbsd.equations.system import ZERO

NODES = (-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640)
WEIGHTS = (0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665, 0.2369268850561891)
"""Gauss-Legendre, five points."""


@internal
def arc_length(numbers, piece, u, scratch):
    """Return arc length at u (m), counted from the begin of the curve; overwrites the scratch."""
    begin = numbers[TABLE + WIDTH * piece]
    inside = u
    if numbers[CLOSED] == 0.0:
        inside = min(max(u, numbers[TABLE]), numbers[TABLE] + numbers[SPAN])
    half = 0.5 * (inside - begin)
    place_on(numbers, piece, inside, scratch)
    straight = (u - inside) * math.sqrt(scratch[DX] * scratch[DX] + scratch[DY] * scratch[DY])
    total = 0.0
    for k in range(5):
        place_on(numbers, piece, begin + half * (1.0 + NODES[k]), scratch)
        total += WEIGHTS[k] * math.sqrt(scratch[DX] * scratch[DX] + scratch[DY] * scratch[DY])
    return numbers[TABLE + WIDTH * piece + ARC] + half * total + straight


@equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers as in curve_pieces.py."""
    find_foot(numbers, relative)
    piece = int(relative[PIECE])
    u = relative[U]
    s = arc_length(numbers, piece, u, relative)
    place_on(numbers, piece, u, relative)
    speed = math.sqrt(relative[DX] * relative[DX] + relative[DY] * relative[DY])
    tx = relative[DX] / speed
    ty = relative[DY] / speed
    bent = tx * relative[DDY] - ty * relative[DDX]
    kappa = bent / (speed * speed)
    stretch = (tx * relative[DDX] + ty * relative[DDY]) / speed  # d speed / ds
    kappa_rate = ((tx * relative[DDDY] - ty * relative[DDDX]) / speed - 3.0 * bent * stretch / speed) / (speed * speed)
    d = tx * (relative[Y] - relative[CY]) - ty * (relative[X] - relative[CX])
    beta = math.atan2(ty, tx)
    near = numbers[TABLE + WIDTH * piece + TANGENT]
    beta += 2.0 * math.pi * math.floor((near - beta) / (2.0 * math.pi) + 0.5)
    r = numbers[RADIUS]
    value = s - r * (beta - relative[A]) - numbers[PHASE] - relative[ZERO]
    if numbers[CLOSED] != 0.0:
        last = TABLE + WIDTH * int(numbers[COUNT])  # a round: arc length and turning of the tangent
        period = abs(numbers[last + LENGTH] - r * numbers[last + TURNING])
        if period > 0.0:
            value -= period * math.floor(value / period + 0.5)
    w = 1.0 - kappa * d
    first = 1.0 - r * kappa
    outer = first * kappa_rate * d / (w * w * w) - r * kappa_rate / (w * w)
    mixed = first * kappa / (w * w)
    clear(out)
    out[F] = value
    out[FX] = first * tx / w
    out[FY] = first * ty / w
    out[FA] = r
    out[FXX] = outer * tx * tx - 2.0 * mixed * tx * ty
    out[FXY] = outer * tx * ty + mixed * (tx * tx - ty * ty)
    out[FYY] = outer * ty * ty + 2.0 * mixed * tx * ty
