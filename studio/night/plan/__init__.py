"""Plan of a night: its options, and the step that may start next; without processes."""
