"""The process in which the author's code runs, forked from one that is warm; it may loop, crash or die."""
