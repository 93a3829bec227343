"""Work of stages on many machines: the cluster's address, its scheduler and workers, its files."""
