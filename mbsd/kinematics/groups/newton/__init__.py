"""Blocks without a closed form, solved by Newton-Raphson in few unknowns; compiled when first used."""
