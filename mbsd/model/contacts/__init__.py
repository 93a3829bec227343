"""Unilateral contacts: what pushes but does not pull, one file a kind, each made of constraints of relative pose."""
