"""Every mechanism of mechanisms/ and each variant: its motion from mechanism.py alone, before it has parts.

All stages of every folder are run by test_mechanisms.py, for the large ones among the slow tests.
"""

from __future__ import annotations

import numpy as np
import pytest

from mechanisms.stages.solve.masses import bare_solution
from tests.mechanisms.every_folder import folders_and_variants


@pytest.mark.parametrize("name", folders_and_variants())
def test_its_motion_closes_at_all_times_and_has_no_gaps(name: str) -> None:
    solution = bare_solution(name)
    assert solution.stats.position_residual < 1e-10
    assert solution.stats.velocity_residual < 1e-8
    assert solution.stats.acceleration_residual < 1e-6
    for body in solution.mechanism.bodies:
        motion = solution.body(body)
        assert np.isfinite(np.column_stack([motion.x, motion.y, motion.theta, motion.omega, motion.alpha])).all()
    moved = [np.ptp(solution.body(body).x) + np.ptp(solution.body(body).theta) for body in solution.mechanism.bodies]
    assert max(moved) > 1e-3, "something moves"
