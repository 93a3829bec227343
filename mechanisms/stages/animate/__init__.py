"""The skeleton in motion, from mechanism.py alone: animation.mp4 and animation.gif."""
