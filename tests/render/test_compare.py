"""All variants of a mechanism on the same pages, from their data.json alone."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest
from matplotlib.text import Text

from mechanisms.stages.solve.motion_file import to_motion
from render.plots import compare
from render.plots.pages import comparison
from shared.contract import Motion, write_motion
from shared.stage import paths
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tools.models.motions import four_bar_motion

VARIANTS = 'VARIANTS = {"longer": {"coupler": 0.13}, "faster": {"speed": 9.0}}\n'


@pytest.fixture
def solved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path) -> dict[str, Motion]:
    """A four-bar and two variants of it, solved."""
    monkeypatch.setattr(paths, "MECHANISMS", tmp_path)
    (tmp_path / "four_bar").mkdir()
    (tmp_path / "four_bar" / "mechanism.py").write_text(VARIANTS)
    motions = {
        "four_bar": four_bar_motion(steps=36),
        "four_bar-longer": four_bar_motion(steps=36, coupler=0.13),
        "four_bar-faster": four_bar_motion(steps=36, speed=9.0),
    }
    for name, motion in motions.items():
        write_motion(Out(name).motion, msgspec.structs.replace(motion, mechanism=name))
    return motions


def test_the_pages_are_drawn_once(solved: dict[str, Motion], capsys: pytest.CaptureFixture[str]) -> None:
    compare.run("four-bar")
    out = Out("four_bar")
    assert sorted(path.stem for path in out.compare.glob("*")) == ["bodies", "drivers", "energy", "paths", "reactions"]
    before = {path: path.read_bytes() for path in out.compare.iterdir()}
    capsys.readouterr()
    compare.run("four-bar-longer")  # asked for by a variant's name, it is the same
    assert capsys.readouterr().out == "compare: four_bar: nothing to do\n"
    (out.compare / "energy.png").write_bytes(b"")
    compare.run("four_bar")
    assert {path: path.read_bytes() for path in out.compare.iterdir()} == before
    motion = Out("four_bar-faster").motion
    motion.write_bytes(motion.read_bytes().replace(b"four_bar-faster", b"four_bar-faster", 1) + b"\n")
    compare.run("four_bar")
    assert "5 plots of 3 variants" in capsys.readouterr().out


def test_each_panel_holds_the_lines_of_all_motions(solved: dict[str, Motion]) -> None:
    motions = {"as it is": solved["four_bar"], "faster": solved["four_bar-faster"]}
    figure = comparison.figures("four_bar", motions)["drivers"]
    torque = figure.axes[0]
    assert torque.get_title(loc="left") == "motor, torque / (mN·m)"
    for line, motion in zip(torque.lines, motions.values(), strict=True):
        np.testing.assert_array_equal(line.get_xdata(), motion.time)
        np.testing.assert_array_equal(line.get_ydata(), motion.drivers["motor"].effort)
    assert torque.lines[0].get_color() != torque.lines[1].get_color()
    said = {text.get_text() for text in figure.findobj(Text) if isinstance(text, Text)}
    assert {"as it is", "faster", "2 motions over time"} <= said


def test_panels_that_differ_most_are_shown(solved: dict[str, Motion]) -> None:
    motion = solved["four_bar"]
    many = {f"j{k}": motion.joints["A"] for k in range(20)}
    other = msgspec.structs.replace(motion.joints["A"], fx=(3.0 * np.array(motion.joints["A"].fx)).tolist())
    motions = {
        "as it is": msgspec.structs.replace(motion, joints=many),
        "other": msgspec.structs.replace(motion, joints=many | {"j17": other}),
    }
    figure = comparison.figures("many", motions)["reactions"]
    titles = [axes.get_title(loc="left") for axes in figure.axes if axes.get_visible()]
    assert len(titles) == comparison.PANELS
    assert "j17, reaction / N" in titles
    assert any("11 more that differ less" in text.get_text() for text in figure.texts)


def test_a_variant_without_a_driver_or_force_leaves_its_lines_out() -> None:
    from mbsd import Mechanism

    def arm(spring: bool) -> Motion:
        m = Mechanism("arm")
        bar = m.bar("bar", 0.2, mass=0.3)
        m.revolute("A", m.ground.at(0, 0), bar.start)
        if spring:
            m.torsion_spring("twist", m.ground, bar, stiffness=0.5)
        return to_motion(m.simulate(0.3, steps=30), None, "", {}, {"bar": "mechanism"})

    figure = comparison.figures("arm", {"as it is": arm(True), "no spring": arm(False)})["forces"]
    assert [len(axes.lines) for axes in figure.axes] == [1, 1]


def test_quantities_without_a_comparison_are_named(solved: dict[str, Motion]) -> None:
    Out("four_bar-longer").motion.unlink()
    with pytest.raises(UserError, match=r"data\.json of 'longer' is missing; run make compare-four-bar"):
        compare.run("four_bar")
    (paths.MECHANISMS / "four_bar" / "mechanism.py").write_text("")
    with pytest.raises(UserError, match=r"four_bar: there is nothing to compare; write VARIANTS = "):
        compare.run("four_bar")
