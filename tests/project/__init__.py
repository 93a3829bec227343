"""What holds the project together: rooms, Makefile, documents, installation."""
