"""What a picture holds and where: how much of it the machine fills, how a camera follows it, where words stand."""
