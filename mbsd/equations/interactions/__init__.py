"""Forces between two markers as functions of how these stand and move against each other, one file each."""
