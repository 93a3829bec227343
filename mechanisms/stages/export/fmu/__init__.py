"""A mechanism as a functional mock-up unit (FMI 3.0) that runs without Python."""
