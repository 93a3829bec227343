"""Views of a solution show themselves in a few lines, and as a small table in a notebook."""

from __future__ import annotations

from xml.etree.ElementTree import fromstring

from mbsd import Mechanism, Solution, constant_rate


def solved() -> Solution:
    m = Mechanism("crank")
    crank = m.bar("crank", 0.05, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(2.0))
    return m.sweep(steps=36)


def test_views_show_ends_and_extremes_with_units() -> None:
    sol = solved()
    for view in (sol.body("crank"), sol.joint("A"), sol.driver("motor"), sol.energy):
        lines = repr(view).splitlines()
        assert lines[0] == f"<{type(view).__name__}: 37 outputs"
        assert len(lines) <= 12
        assert max(map(len, lines)) < 100
    (theta,) = (line for line in repr(sol.body("crank")).splitlines() if line.split()[0] == "theta")
    assert theta.split() == ["theta", "0", "..", "6.283", "least", "0,", "most", "6.283", "rad"]
    assert "effort" in repr(sol.driver("motor"))
    assert "rad/s" in repr(sol.driver("motor"))


def test_a_notebook_gets_a_table() -> None:
    table = fromstring(solved().body("crank")._repr_html_())
    rows = [[cell.text or "" for cell in row] for row in table.iter("tr")]
    assert rows[0] == ["", "unit", "first", "least", "most", "last"]
    assert ["omega", "rad/s", "2", "2", "2", "2"] in rows
