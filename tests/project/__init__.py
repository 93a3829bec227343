"""Tests of what holds the project together: rooms, Makefile, documents, installation."""
