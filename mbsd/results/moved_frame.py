"""The motion of a frame of a body, from that of its centre of mass.

p = r + s,   p' = r' + omega s_perp,   p'' = r'' + alpha s_perp - omega^2 s;   s_perp = (-s_y, s_x)
"""

from __future__ import annotations

import numpy as np

from mbsd.results.views import FrameView


def moved_frame(q: np.ndarray, v: np.ndarray, a: np.ndarray, local: np.ndarray, turned: float = 0.0) -> FrameView:
    """From q, v, a (T, 3) of the centre of mass; ``local`` (2,) from there in body axes (m), ``turned`` by an angle."""
    c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
    arm_x, arm_y = c * local[0] - s * local[1], s * local[0] + c * local[1]
    omega, alpha = v[:, 2], a[:, 2]
    return FrameView(
        x=q[:, 0] + arm_x,
        y=q[:, 1] + arm_y,
        theta=q[:, 2] + turned,
        vx=v[:, 0] - omega * arm_y,
        vy=v[:, 1] + omega * arm_x,
        omega=omega,
        ax=a[:, 0] - alpha * arm_y - omega**2 * arm_x,
        ay=a[:, 1] + alpha * arm_x - omega**2 * arm_y,
        alpha=alpha,
    )
