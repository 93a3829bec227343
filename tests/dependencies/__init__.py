"""What a user's code depends on."""
