"""The page in Firefox and in Safari's browser: `make view-engines`.

CONTRIBUTING.md lists what it needs.
"""
