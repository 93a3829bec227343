"""The program ``mbsd``: one table of commands for any folder; the Makefile offers the same table."""
