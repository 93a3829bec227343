"""What is beside the workers of the rounds: one that lies, and a study."""
