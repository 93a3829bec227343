"""Server of the live page: it watches a mechanism's files, solves after saving and pushes changes."""
