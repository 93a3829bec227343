"""The stages, and every folder of mechanisms/."""
