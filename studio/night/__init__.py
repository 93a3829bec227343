"""Night shift: every stage of every mechanism to its end, whatever happens on the way."""
