"""What a motion may not pass: limits and stops of joints, contacts, crossings of curves, wheels that meet."""
