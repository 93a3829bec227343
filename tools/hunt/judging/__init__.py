"""Whether solutions agree, and what any solution must fulfil by itself."""
