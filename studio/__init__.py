"""Programs that run the stages for a user: the command line, the live page, the night shift, the site."""
