"""Tests; a package, so that helpers like tests.motions are found before anyone else's ``tests``."""
