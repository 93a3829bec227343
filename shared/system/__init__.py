"""What the project needs of the system: libraries and programs, and the packages that bring them."""
