"""The variations of a driven and of a free motion."""
