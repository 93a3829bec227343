"""Random mechanisms: what the hunts solve, what parts are built for, and what property tests draw."""
