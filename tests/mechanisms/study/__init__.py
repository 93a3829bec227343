"""Tests of the stage study."""
