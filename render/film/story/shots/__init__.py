"""The shots of a story, a file each; they are chosen and timed from the files of a mechanism."""
