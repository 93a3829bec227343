"""What Blender does not save is a sentence, and leaves nothing behind."""

from __future__ import annotations

from pathlib import Path

import pytest

from render.blender.worker.picture import save_whole
from shared.stage.errors import UserError


def whole(path: Path) -> str | None:
    """The check of a file that must hold ``whole``."""
    return None if path.exists() and path.read_bytes() == b"whole" else "is cut short"


def test_an_error_of_blender_is_tried_again_and_then_told(tmp_path: Path) -> None:
    part, calls = tmp_path / "part", []

    def fails(path: Path) -> None:
        calls.append(path)
        raise RuntimeError("Error: No space left on device\n")

    with pytest.raises(UserError, match=r"the file that Blender saved was not written \(Error: No space left"):
        save_whole(part, fails, whole, 1000, "scene.blend")
    assert len(calls) == 2
    assert list(tmp_path.iterdir()) == []


def test_a_second_attempt_may_succeed(tmp_path: Path) -> None:
    part, calls = tmp_path / "part", []

    def at_last(path: Path) -> None:
        calls.append(path)
        if len(calls) == 1:
            raise RuntimeError("Error: device busy")
        path.write_bytes(b"whole")

    save_whole(part, at_last, whole, 1000, "scene.blend")
    assert part.read_bytes() == b"whole"
