"""Many simulations of one mechanism in space: what varies, rows of the planar compiled loop, and what is measured."""
