"""Sources of sound: a file each, which opens with its equations. None of them asks for a kind."""
