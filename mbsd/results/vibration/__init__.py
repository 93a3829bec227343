"""What makes the frame vibrate: forces and moments of inertia, and their harmonics against the crank."""
