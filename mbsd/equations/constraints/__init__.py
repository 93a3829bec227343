"""Constraints: the equations that joints and drivers are made of, one file each.

Every file has ``rows`` (residual and Jacobian) and ``gamma_rows`` (acceleration right-hand side), each with its own
loop over its table of the System. J v = nu and J a = gamma; nu and the f'' part of gamma of a driven row are
added by assembly.py for all kinds alike.
"""
