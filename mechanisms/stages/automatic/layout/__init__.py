"""What takes room, in which layer and at which height. It knows no kind of joint."""
