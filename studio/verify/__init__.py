"""Same inputs, same outputs: a mechanism's files made again in fresh processes and compared with those that are there."""
