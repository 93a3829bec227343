"""The world around a machine: lights, sky, ground, walls, and the things of a workshop."""
