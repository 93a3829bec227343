"""Topology diagrams: all names are there, what is redundant is marked, and boxes of bodies keep apart."""

from __future__ import annotations

import itertools
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError
from tests.dynamics.test_simulate import n_four_bar
from tests.kinematics.test_mobility import parallelogram


def boxes(text: str) -> list[tuple[float, float, float, float]]:
    """Boxes of the bodies in a topology diagram."""
    out = []
    for element in ET.fromstring(text).iter():
        if element.tag.endswith("rect") and element.attrib.get("rx") == "7":
            x, y, width, height = (float(element.attrib[key]) for key in ("x", "y", "width", "height"))
            out.append((x, y, x + width, y + height))
    return out


def test_bodies_without_joints_have_a_topology() -> None:
    m = Mechanism("loose")
    m.rigid_contact("floor", m.ground.origin, m.body("ball", 1.0, inertia=1.0).origin, radius=0.1)
    assert {"ground", "ball"} <= {element.text for element in ET.fromstring(m.topology().text).iter()}


def test_the_topology_names_all_and_marks_the_redundant() -> None:
    m = parallelogram()
    text = m.topology().text
    shown = {e.text for e in ET.fromstring(text).iter() if e.tag.endswith("text")}
    assert {
        *m.bodies,
        *m.joints,
        "1 degree of freedom (0 nominal), 1 redundant row, removable at F; no drivers",
    } <= shown
    assert [e.text for e in ET.fromstring(text).iter() if e.text and "redundant" in e.text][1:] == [
        "revolute, redundant"
    ]
    assert text.count("stroke-dasharray") == 2
    assert len(boxes(text)) == len(m.bodies)
    assert "stroke-dasharray" not in parallelogram(extra=False).topology().text


@settings(max_examples=25)
@given(extra=st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)), max_size=5), count=st.integers(1, 8))
def test_boxes_of_bodies_do_not_overlap(extra: list[tuple[int, int]], count: int) -> None:
    m = Mechanism("random")
    bodies = [m.ground, *(m.bar(f"link {k}", 1.0) for k in range(count))]
    for k in range(count):
        m.revolute(f"J{k}", bodies[k].at(1, 0), bodies[k + 1].at(0, 0))
    for k, (a, b) in enumerate(extra):
        if a != b and max(a, b) <= count:
            m.pin_in_slot(f"S{k}", bodies[a].at(0.5, 0), bodies[b].at(0.5, 0.1))
    for a, b in itertools.combinations(boxes(m.topology().text), 2):
        assert a[2] < b[0] or b[2] < a[0] or a[3] < b[1] or b[3] < a[1]


def test_names_are_escaped_and_a_huge_model_is_refused() -> None:
    m = Mechanism("a<b>&c")
    m.revolute('pin "1" <&>', m.ground.at(0, 0), m.bar("<link>", 1.0).start)
    ET.fromstring(m.topology().text)
    big = Mechanism("big")
    for k in range(700):
        big.bar(f"b{k}", 1.0)
    with pytest.raises(ModelError, match="701 bodies, joints and drivers are too many"):
        big.topology()


def test_a_diagram_of_thirty_loops_has_no_boxes_on_each_other() -> None:
    drawn = n_four_bar(30).topology().text
    assert drawn == n_four_bar(30).topology().text
    rectangles = np.array(boxes(drawn))
    assert len(rectangles) == 62
    apart = (rectangles[:, None, 2:] < rectangles[None, :, :2]).any(axis=2)
    assert (apart | apart.T | np.eye(len(rectangles), dtype=bool)).all()
