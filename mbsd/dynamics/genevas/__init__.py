"""Genevas in independent coordinates: steps that end where their pins enter or leave."""
