"""Deal of work to workers of a Dask cluster or processes of this computer.

It knows no mechanism and no stage.
"""
