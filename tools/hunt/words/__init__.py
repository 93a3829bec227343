"""One mechanism in other words: what must not change its motion."""
