"""DXF files have the same bytes in every process, and layers that programs can read, whatever bodies are called."""

from __future__ import annotations

import io
import os
import subprocess
import sys

from ezdxf.filemanagement import new, read
from ezdxf.lldxf.validator import is_valid_table_name
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mechanisms.stages.dxf_file import LONGEST, Layers
from mechanisms.stages.export.drawings import dxf
from shared.stage.paths import ROOT

BOTH = """
import cadquery
from mbsd import Mechanism, constant_rate
from mechanisms.stages.export import drawings
from mechanisms.stages.print import plates
m = Mechanism("crank")
crank = m.bar("crank", 0.05, mass=1.0)
m.revolute("A", m.ground.at(0, 0), crank.start)
m.drive_angle("motor", crank, constant_rate(1.0))
print(drawings.dxf(m.sweep(steps=8), 0.0))
cut = cadquery.Workplane().ellipse(20, 10).spline([(30, 0), (40, 5), (50, -3)]).circle(4).rect(80, 60)
print(plates.dxf(cut, 5.0).decode())
"""


def _printed(seed: int) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": str(seed), "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", BOTH], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_another_process_at_another_time_writes_the_same_bytes() -> None:
    assert _printed(1) == _printed(2)


def test_bodies_with_names_that_no_layer_can_have_are_drawn() -> None:
    """This ended in a traceback of ezdxf."""
    m = Mechanism("press")
    crank, rod = m.bar("crank: 1/2*", 0.05, mass=1.0), m.bar("Crank_ 1_2_", 0.15, mass=1.0)
    slider = m.body("signs", mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.trace("a<b", rod.end)
    m.start_near(**{"crank: 1/2*": 0.0, "Crank_ 1_2_": 0.0})
    document = read(io.StringIO(dxf(m.sweep(steps=8), 0.0)))
    layers = {entity.dxf.layer for entity in document.modelspace()}
    assert {"crank_ 1_2_", "Crank_ 1_2_ (2)", "path a_b", "ground"} <= layers
    assert len({layer for layer in layers if layer.startswith("signs")}) == 2


@given(st.lists(st.text(min_size=1, max_size=300), min_size=1, max_size=6, unique=True))
def test_every_name_has_a_layer_of_its_own(names: list[str]) -> None:
    document = new("R2010")
    layers = Layers(document)
    allowed = [layers.named(name) for name in names]
    assert [layers.named(name) for name in names] == allowed
    assert len({name.casefold() for name in allowed}) == len(names)
    assert all(is_valid_table_name(name) and 0 < len(name) <= LONGEST and name.isprintable() for name in allowed)
    assert all(document.layers.has_entry(name) for name in allowed)
