"""Tests of the content of pictures."""
