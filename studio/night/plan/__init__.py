"""What is asked of a night, and which step may start next; without processes."""
