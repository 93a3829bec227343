"""Tests of the stage tolerances."""
