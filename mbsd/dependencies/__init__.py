"""Inputs of a user's code, recorded while it runs: modules, files, folders, variables, packages."""
