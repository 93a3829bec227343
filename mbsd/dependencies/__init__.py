"""What a user's code depends on, recorded while it runs, and hashed: modules, files, folders, variables, packages."""
