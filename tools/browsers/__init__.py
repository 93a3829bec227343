"""The page in the engines of Firefox and Safari: `make view-engines`. CONTRIBUTING.md says what it needs."""
