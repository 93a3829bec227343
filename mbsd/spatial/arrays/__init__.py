"""From names to arrays: the system of a mechanism in space, and its rows and bodies by name."""
