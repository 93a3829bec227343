"""The layout: items that take room, their layers and their heights. It knows no kind of joint."""
