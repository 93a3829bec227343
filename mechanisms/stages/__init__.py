"""The stages of a mechanism: each makes files of its folder and of the files before it. They import mbsd and shared."""
