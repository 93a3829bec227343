"""The start pose and its rank; the driven motion, in closed form or by Newton-Raphson."""
