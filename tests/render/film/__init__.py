"""Tests of render/film."""
