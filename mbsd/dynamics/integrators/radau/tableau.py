"""Coefficients of Radau IIA of order 5 with three stages, in the form that decouples its linear equations.

C: nodes. A^-1 = T diag(REAL, [[PART, -TURN], [TURN, PART]]) TI with h-free eigenvalues REAL and PART +- i TURN.
E: the embedded error estimate of order 3. D: collocation polynomial, Z(x) = sum_k x^(k+1) sum_i D[i, k] Z_i.
WEIGHTS: rows integrate a quadratic through the nodes from 0 to each of them (the matrix A of the method).

Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5 and IV.8; decimals of T as in scipy 1.18.
"""

from __future__ import annotations

import numpy as np

ROOT6 = 6.0**0.5
C = np.array([(4.0 - ROOT6) / 10.0, (4.0 + ROOT6) / 10.0, 1.0])
E = np.array([-13.0 - 7.0 * ROOT6, -13.0 + 7.0 * ROOT6, -1.0]) / 3.0
REAL = 3.0 + 3.0 ** (2.0 / 3.0) - 3.0 ** (1.0 / 3.0)
PART = 3.0 + 0.5 * (3.0 ** (1.0 / 3.0) - 3.0 ** (2.0 / 3.0))
TURN = -0.5 * (3.0 ** (5.0 / 6.0) + 3.0 ** (7.0 / 6.0))
WEIGHTS = np.array(
    [
        [(88.0 - 7.0 * ROOT6) / 360.0, (296.0 - 169.0 * ROOT6) / 1800.0, (-2.0 + 3.0 * ROOT6) / 225.0],
        [(296.0 + 169.0 * ROOT6) / 1800.0, (88.0 + 7.0 * ROOT6) / 360.0, (-2.0 - 3.0 * ROOT6) / 225.0],
        [(16.0 - ROOT6) / 36.0, (16.0 + ROOT6) / 36.0, 1.0 / 9.0],
    ]
)
T = np.array(
    [
        [0.09443876248897524, -0.14125529502095421, 0.03002919410514742],
        [0.25021312296533332, 0.20412935229379994, -0.38294211275726192],
        [1.0, 1.0, 0.0],
    ]
)
TI = np.array(
    [
        [4.17871859155190428, 0.32768282076106237, 0.52337644549944951],
        [-4.17871859155190428, -0.32768282076106237, 0.47662355450055044],
        [0.50287263494578682, -2.57192694985560522, 0.59603920482822492],
    ]
)
D = np.array(
    [
        [13.0 / 3.0 + 7.0 * ROOT6 / 3.0, -23.0 / 3.0 - 22.0 * ROOT6 / 3.0, 10.0 / 3.0 + 5.0 * ROOT6],
        [13.0 / 3.0 - 7.0 * ROOT6 / 3.0, -23.0 / 3.0 + 22.0 * ROOT6 / 3.0, 10.0 / 3.0 - 5.0 * ROOT6],
        [1.0 / 3.0, -8.0 / 3.0, 10.0 / 3.0],
    ]
)
