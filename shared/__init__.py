"""What every room may use: the files that cross a process, the folders they live in, the console."""
