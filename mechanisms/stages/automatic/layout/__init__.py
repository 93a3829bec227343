"""What takes room, in which layer, and at which height; it knows no kind of joint."""
