"""Mount of a mechanism: the one that follows from gravity, and ones that files may not have."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shared.contract import Mount, mounted, read_parts, write_parts
from shared.stage.errors import UserError
from tools.fixtures import film_fixture


@given(st.floats(-math.pi, math.pi), st.floats(1e-3, 100))
def test_up_is_against_gravity(angle: float, pull: float):
    gravity = pull * math.cos(angle), pull * math.sin(angle)
    mount = mounted(gravity)
    assert mount.kind == "stand"
    assert mount.up == pytest.approx((-math.cos(angle), -math.sin(angle), 0.0))
    assert mounted(gravity, runs_on_ground=True) == Mount(kind="ground", up=mount.up)
    assert mounted(gravity, "wall", runs_on_ground=True) == Mount(kind="wall", up=mount.up)
    assert mounted(gravity, "desk") == Mount()


def test_without_gravity_it_lies_unless_one_wishes_otherwise():
    assert mounted((0.0, 0.0)) == mounted((0.0, 0.0), runs_on_ground=True) == Mount()
    assert mounted((0.0, 0.0), "stand") == Mount(kind="stand", up=(0.0, 1.0, 0.0))
    assert mounted((0.0, -9.81)).up == (0.0, 1.0, 0.0)


def test_a_file_without_a_mount_is_of_a_machine_on_a_desk(out_root: Path):
    out = film_fixture.write(mount=mounted((0.0, -9.81)))
    assert read_parts(out.parts).mount == Mount(kind="stand", up=(0.0, 1.0, 0.0))
    older = msgspec.json.decode(out.parts.read_bytes())
    del older["mount"]
    out.parts.write_bytes(msgspec.json.encode(older))
    assert read_parts(out.parts).mount == Mount()


@pytest.mark.parametrize(
    ("mount", "words"),
    [
        (Mount(kind="desk", up=(0.0, 1.0, 0.0)), r"mount: up is \(0, 1, 0\); on a desk it is \(0, 0, 1\)"),
        (Mount(kind="stand"), r"mount: up is \(0, 0, 1\); what stands has a unit vector in the plane"),
        (Mount(kind="wall", up=(0.6, 0.7, 0.0)), r"mount: up is \(0\.6, 0\.7, 0\); what stands has a unit vector"),
        (Mount(kind="ceiling", up=(0.0, 1.0, 0.0)), "kind"),  # type: ignore[arg-type]
    ],
)
def test_invalid_requests_are_refused(out_root: Path, mount: Mount, words: str):
    out = film_fixture.write()
    parts = read_parts(out.parts)
    parts.mount = mount
    with pytest.raises(UserError, match=words):
        write_parts(out.parts, parts)
