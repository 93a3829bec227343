"""Blocks that no closed form covers, solved by Newton-Raphson in their few unknowns; compiled when first used."""
