"""Counterweights, balance shafts and flywheels that make a machine shake less."""
