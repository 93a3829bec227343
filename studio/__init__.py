"""What runs the stages for a user who is elsewhere: the night shift, and the page that follows the editor."""
