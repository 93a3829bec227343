"""Models that tests of several rooms use."""
