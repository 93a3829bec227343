"""The proof that no two parts touch over the whole motion: clearance.json. Lengths are millimetres."""
