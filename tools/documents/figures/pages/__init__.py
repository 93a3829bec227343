"""Pictures of pages, each file named as its page: ``pictures`` gets the variables that the code of the page leaves."""
