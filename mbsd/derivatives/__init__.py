"""Derivatives of motions and of what is measured of them by numbers of the model: lengths, places, masses, laws."""
