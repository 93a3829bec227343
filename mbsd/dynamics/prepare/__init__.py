"""All that a simulation needs before its first step."""
