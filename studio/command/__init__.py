"""The program ``mbsd``: one table of commands, for any folder; the Makefile is a face of the same table."""
