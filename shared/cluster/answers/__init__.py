"""What workers answer: bytes of a format that runs nothing, believed only after every value in it was checked."""
