"""How a stage runs: paths, files, console, errors, and whether there is anything to do."""
