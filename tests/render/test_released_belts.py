"""A belt that an event releases is gone from pictures from then on; so is a rod from where it was joined."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism
from mechanisms.stages.solve.motion_file import to_motion
from render.film.poses import Moment, Poses
from render.film.tubes.belts import belts
from render.glb.document import Animation, Document, Paints
from render.glb.tubes import add_belt
from render.report.travel import releases
from shared.contract import Held, Motion

RELEASE = 0.5


@pytest.fixture(scope="module")
def motion() -> Motion:
    """Two pulleys; the belt slips off after half a second."""
    m = Mechanism("unbelted")
    first, second = m.body("first", 1.0, inertia=0.002), m.body("second", 2.0, inertia=0.004)
    m.revolute("A", m.ground.at(0, 0), first.origin)
    m.revolute("B", m.ground.at(0.25, 0), second.origin)
    belt = m.belt("belt", first.origin, second.origin, 0.04, 0.06)
    m.event("slips off", lambda t, moment: t - RELEASE, releases=[belt])
    m.start_moving(first=6.0)
    return to_motion(m.simulate(1.0, steps=50, event_rows=True), None, "0" * 64, {})


def test_data_json_says_when_a_joint_is_released(motion: Motion) -> None:
    assert motion.joints["belt"].released == pytest.approx(RELEASE)
    assert motion.joints["A"].released is None
    row = motion.joints["belt"].rows_held(motion.time)
    assert motion.time[row - 1] == motion.time[row] == pytest.approx(RELEASE)
    assert motion.joints["A"].rows_held(motion.time) == len(motion.time)
    assert releases(motion) == {"belt": (row, "slips off")}


def test_its_tubes_shrink_to_a_point(motion: Motion) -> None:
    [belt] = belts(motion, {"belt": Held(z=0.01, radius=0.002)})
    poses = Poses(motion)
    for time, is_there in ((0.2, True), (RELEASE, True), (0.51, False), (1.0, False)):
        for path in belt.paths(poses, Moment(time, 0)):
            assert bool(np.ptp(path, axis=0).any()) is is_there
    document = Document()
    animation = Animation(document, motion)
    nodes = add_belt(document, animation, Paints(document), poses, belt)
    scales = {track.node: track.values for track in animation.tracks if track.path == "scale"}
    assert set(scales) == set(nodes)
    for values in scales.values():
        assert values[0].tolist() == [1.0] * 3
        assert values[-1].tolist() == [0.0] * 3
