"""The loop at the top of README.md: twelve lines with one number changing, and the four-bar that they build."""
