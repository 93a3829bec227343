"""The workers of a Dask cluster: which of them are fit for a study, and whether their answers can be believed."""
