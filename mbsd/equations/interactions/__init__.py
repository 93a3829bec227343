"""Forces between two markers as functions of their relative pose and motion, one file each."""
