"""Commands for a night from elsewhere: start it in the background, look at it, stop it."""
