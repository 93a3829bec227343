"""What both sides of the line use; it knows no other room."""
