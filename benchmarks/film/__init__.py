"""Cost of a film beside the renderer alone, a plain script, a run that was killed, one core, nothing to do."""
