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
from mbsd.equations.relative import curve_pieces as pieces
from mbsd.equations.relative import equation
from mbsd.equations.system import ZERO

NODES = (-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640)
WEIGHTS = (0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665, 0.2369268850561891)
"""Gauss-Legendre, five points."""


@internal
def arc_length(numbers, piece, u, scratch):
    """Return arc length at u (m), counted from the begin of the curve; overwrites the scratch."""
    begin = numbers[pieces.TABLE + pieces.WIDTH * piece]
    inside = u
    if numbers[pieces.CLOSED] == 0.0:
        inside = min(max(u, numbers[pieces.TABLE]), numbers[pieces.TABLE] + numbers[pieces.SPAN])
    half = 0.5 * (inside - begin)
    pieces.place_on(numbers, piece, inside, scratch)
    straight = (u - inside) * math.sqrt(
        scratch[pieces.DX] * scratch[pieces.DX] + scratch[pieces.DY] * scratch[pieces.DY]
    )
    total = 0.0
    for k in range(5):
        pieces.place_on(numbers, piece, begin + half * (1.0 + NODES[k]), scratch)
        total += WEIGHTS[k] * math.sqrt(
            scratch[pieces.DX] * scratch[pieces.DX] + scratch[pieces.DY] * scratch[pieces.DY]
        )
    return numbers[pieces.TABLE + pieces.WIDTH * piece + pieces.ARC] + half * total + straight


@equation.equation
def residual(numbers, relative, out):
    """Fill F (m); own numbers as in curve_pieces.py."""
    pieces.find_foot(numbers, relative)
    piece = int(relative[pieces.PIECE])
    u = relative[pieces.U]
    s = arc_length(numbers, piece, u, relative)
    pieces.place_on(numbers, piece, u, relative)
    speed = math.sqrt(relative[pieces.DX] * relative[pieces.DX] + relative[pieces.DY] * relative[pieces.DY])
    tx = relative[pieces.DX] / speed
    ty = relative[pieces.DY] / speed
    bent = tx * relative[pieces.DDY] - ty * relative[pieces.DDX]
    kappa = bent / (speed * speed)
    stretch = (tx * relative[pieces.DDX] + ty * relative[pieces.DDY]) / speed  # d speed / ds
    kappa_rate = ((tx * relative[pieces.DDDY] - ty * relative[pieces.DDDX]) / speed - 3.0 * bent * stretch / speed) / (
        speed * speed
    )
    d = tx * (relative[equation.Y] - relative[pieces.CY]) - ty * (relative[equation.X] - relative[pieces.CX])
    beta = math.atan2(ty, tx)
    near = numbers[pieces.TABLE + pieces.WIDTH * piece + pieces.TANGENT]
    beta += 2.0 * math.pi * math.floor((near - beta) / (2.0 * math.pi) + 0.5)
    r = numbers[pieces.RADIUS]
    value = s - r * (beta - relative[equation.A]) - numbers[equation.PHASE] - relative[ZERO]
    if numbers[pieces.CLOSED] != 0.0:
        # a round: arc length and turning of the tangent
        last = pieces.TABLE + pieces.WIDTH * int(numbers[pieces.COUNT])
        period = abs(numbers[last + pieces.LENGTH] - r * numbers[last + pieces.TURNING])
        if period > 0.0:
            value -= period * math.floor(value / period + 0.5)
    w = 1.0 - kappa * d
    first = 1.0 - r * kappa
    outer = first * kappa_rate * d / (w * w * w) - r * kappa_rate / (w * w)
    mixed = first * kappa / (w * w)
    equation.clear(out)
    out[equation.F] = value
    out[equation.FX] = first * tx / w
    out[equation.FY] = first * ty / w
    out[equation.FA] = r
    out[equation.FXX] = outer * tx * tx - 2.0 * mixed * tx * ty
    out[equation.FXY] = outer * tx * ty + mixed * (tx * tx - ty * ty)
    out[equation.FYY] = outer * ty * ty + 2.0 * mixed * tx * ty
