"""Compiled: Phi, J, nu, gamma and Q at one state, on arrays alone, without a name."""
