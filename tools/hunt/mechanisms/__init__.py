"""Random mechanisms, a file a kind of mechanism; each enters its families, and all files are found by themselves."""
