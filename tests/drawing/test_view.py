"""The small page: it holds the motion, needs nothing from outside, and refuses what it cannot show."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, Solution
from tools.models import linkages


@pytest.fixture(scope="module")
def sol() -> Solution:
    m = linkages.four_bar(0.12, 0.04, 0.12, 0.09)
    m.trace("P", m.bodies["coupler"].at(0.06, 0.03))
    return m.sweep(duration=1.0, steps=720)


def test_a_file_and_a_notebook_show_the_same_motion(sol: Solution, tmp_path: Path) -> None:
    shown = sol.view(tmp_path / "four.html")
    page = (tmp_path / "four.html").read_text()
    assert page == shown.html == sol.view().html
    assert html.escape(page) in shown._repr_html_()
    assert len(page) < 400_000
    assert not re.search(r"https?:|src=|<link|import\(|fetch\(", page)
    call = re.search(r"\)\(document\.body, (.*)\);\n</script>", page)
    assert call
    data = json.loads(call[1])
    assert data["loops"]
    assert len(data["t"]) == 361
    kept = np.round(np.array(data["t"]) * 720).astype(int)
    for name, (x, y, theta) in data["bodies"].items():
        view = sol.body(name)
        assert x == pytest.approx(view.x[kept], abs=1e-8)
        assert y == pytest.approx(view.y[kept], abs=1e-8)
        assert theta == pytest.approx(view.theta[kept], abs=1e-6)
    assert {label["text"] for label in data["names"]} >= {"A", "B", "C", "D", "P", "crank"}
    path = np.reshape(data["paths"][0], (-1, 2))
    assert path[:, 0] == pytest.approx(sol.point("P").x[kept], abs=1e-6)


def test_a_notebook_shows_a_solution_in_motion_with_its_numbers(sol: Solution) -> None:
    shown = sol._repr_html_()
    assert shown.count("<iframe") == 1
    assert "crank.theta [rad]" in shown


def test_names_cannot_leave_the_script() -> None:
    m = Mechanism("odd")
    bar = m.bar("bar</script><b>", 0.1, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), bar.start)
    page = m.simulate(0.2, steps=8).view().html
    assert page.count("</script>") == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [({"height": 10}, "give 120 or more"), ({"height": "x"}, "height"), ({"path": "/nowhere/x.html"}, "cannot write")],
)
def test_invalid_requests_are_refused(sol: Solution, arguments: dict, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        sol.view(**arguments)


def test_one_time_is_no_motion(sol: Solution) -> None:
    snapshot = sol.mechanism.sweep(times=[0.5])
    with pytest.raises(ModelError, match="draw\\(\\) a pose"):
        snapshot.view()
