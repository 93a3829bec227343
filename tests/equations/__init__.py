"""Tests of equations."""
