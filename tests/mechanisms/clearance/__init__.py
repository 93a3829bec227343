"""Tests of mechanisms/clearance."""
