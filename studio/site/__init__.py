"""The site: a wall of machines in motion, and a page for each with its film, its numbers to move and its files."""
