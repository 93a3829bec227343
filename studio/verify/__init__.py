"""Same inputs, same outputs: files of a mechanism made again in fresh processes, beside those that are there."""
