"""A mechanism by name, checked as it is built: bodies, joints, drivers, forces, contacts, laws.

It needs no kernel and no compiler.
"""
