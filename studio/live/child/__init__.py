"""Process that runs the author's code, forked from a warm one; it may loop, crash or die."""
