"""Every page and a picture of each: ``mbsd view-all`` goes on after failures and after a stop."""
