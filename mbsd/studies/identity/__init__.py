"""What makes a study the same one: the content of build and measure, and the inputs that they have beside it."""
