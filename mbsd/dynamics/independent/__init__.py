"""Forward dynamics in independent coordinates, where a mechanism falls apart into driven bodies, trains and groups.

    q = q(z, t),   q' = B z' + b,   q'' = B z'' + c
    (B^T M B) z'' = B^T (Q - M c)

The dependent coordinates are eliminated group by group in closed form, so that no constraint can drift and no
multiplier is solved for. Source: Wehage, Haug 1982, J. Mech. Design 104; Shabana, Dynamics of Multibody Systems,
ch. 3 (embedding technique).
"""
