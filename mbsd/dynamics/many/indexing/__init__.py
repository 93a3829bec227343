"""Genevas in the compiled loop over simulations: steps in independent coordinates that end where pins enter or leave."""
