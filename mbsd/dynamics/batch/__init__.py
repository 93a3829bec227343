"""Many simulations of one mechanism: what varies, chunks of rows in threads, and a table of results."""
