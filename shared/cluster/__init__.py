"""Work of stages on many machines: where the cluster is, its scheduler and workers, and files by content."""
