"""Files that runs keep in out/night: locks, records, the log."""
