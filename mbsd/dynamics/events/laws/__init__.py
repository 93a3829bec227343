"""Laws of impact, contact and friction at events, as complementarity problems."""
