"""Models that tests of several rooms share."""
