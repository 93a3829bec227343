"""The parts of a picture that change while the camera stands: where they are, and how they join the plate."""
