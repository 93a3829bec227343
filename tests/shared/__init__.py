"""The contract, how a stage runs, and the shapes."""
