"""Points carried by bodies and bodies hung on points: with rates, as places alone, and for each column of B."""
