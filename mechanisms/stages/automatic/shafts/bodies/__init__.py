"""What each body of such a machine becomes: in which planes its joints act, and what its bodies are."""
