"""mbsd with all its rooms as sdist and wheels."""
