"""How long one waits for a first result, where nothing is compiled yet, and for calls as users make them."""
