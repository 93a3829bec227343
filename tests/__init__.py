"""Tests; a package, so that helpers like tests.models.motions are found before anyone else's ``tests``."""
