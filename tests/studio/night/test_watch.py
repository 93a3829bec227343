"""Longest silence of a step."""

from __future__ import annotations

import pytest

from render.blender.process import FLOOR, KERNELS, TIMES
from studio.night.process import STAGE, TWICE, limit


def test_a_render_has_ten_times_a_picture_twice_over_because_its_stage_starts_blender_again(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.delenv("MBSD_PATIENCE", raising=False)
    assert limit(True, 100.0, 3) == pytest.approx(TWICE * TIMES * 100.0)
    assert limit(True, 0.1, 3) == pytest.approx(TWICE * FLOOR)
    assert limit(True, None, 3) == pytest.approx(TWICE * FLOOR)
    assert TWICE > 2


def test_the_first_picture_has_time_for_the_kernels_of_a_gpu(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("MBSD_PATIENCE", raising=False)
    assert limit(True, 0.1, 0) == pytest.approx(TWICE * KERNELS)


def test_steps_without_pictures_have_an_hour_whatever_a_picture_takes(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("MBSD_PATIENCE", raising=False)
    assert limit(False, 1000.0, 0) == STAGE
    monkeypatch.setenv("MBSD_PATIENCE", str(FLOOR / 60))
    assert limit(False, None, 0) == pytest.approx(STAGE / 60)
