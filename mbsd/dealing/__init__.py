"""Deals work out to workers: a Dask cluster's, or processes of this machine. It knows no mechanism and no stage."""
