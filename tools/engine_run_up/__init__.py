"""Engines on mounts through run-up and resonance: out/engines/run_up.* and a table of docs/engines.md."""
