"""Published answers: numbers of others."""
