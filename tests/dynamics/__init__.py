"""Forward dynamics, integrators, contacts and friction by events."""
