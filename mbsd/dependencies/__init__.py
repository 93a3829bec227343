"""Inputs of a user's code, recorded while it runs, and hashed: modules, files, folders, variables, packages."""
