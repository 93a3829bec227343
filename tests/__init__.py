"""Tests; a package, so that helpers like tests.running.needs are found before anyone else's ``tests``."""
