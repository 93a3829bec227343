"""The stages: each reads files of a mechanism and writes others. They import `mbsd` and `shared`."""
