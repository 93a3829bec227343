"""What holds a machine whose plane stands: foot, column and screws behind its plate, or the ground under a road."""
