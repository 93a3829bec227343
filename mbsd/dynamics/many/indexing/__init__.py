"""Genevas in the compiled loop over simulations: steps that end where their pins enter or leave."""
