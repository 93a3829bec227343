"""Start, rank and mobility of large mechanisms."""
