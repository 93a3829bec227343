"""How a stage runs: paths, files, console, errors, and what decides whether it is done again."""
