"""The parts of a mechanism made by a worker of a cluster, from the author's files by content."""
