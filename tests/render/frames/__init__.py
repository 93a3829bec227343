"""Tests of render/frames."""
