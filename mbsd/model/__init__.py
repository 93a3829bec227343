"""A mechanism by name, which refuses what cannot be: bodies, joints, drivers, forces, contacts, laws. No kernel, no
compiler.
"""
