"""Studies of engines for docs/engines.md and out/engines/."""
