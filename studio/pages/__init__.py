"""Every page and a picture of each: `make view-all`; it goes on after failures and from where it was stopped."""
