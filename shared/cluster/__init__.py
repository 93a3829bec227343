"""Work on many machines: the bridge to Dask distributed, and the same work in local processes without it."""
