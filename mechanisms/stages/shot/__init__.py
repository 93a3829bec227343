"""The description of the film, checked: shot.json."""
