"""Running of a stage: paths, files, console, errors, and whether there is anything to do."""
