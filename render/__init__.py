"""Everything that is seen: plots, report, pictures and films, from files alone."""
