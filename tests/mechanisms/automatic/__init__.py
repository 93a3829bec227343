"""Tests of mechanisms/automatic."""
