"""Tests of the project as a whole: rooms, Makefile, documents, installation."""
