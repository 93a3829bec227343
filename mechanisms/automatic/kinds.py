"""Every kind of joint that has parts by itself: importing a line's module enters it."""

from mechanisms.automatic import pins  # noqa: F401  revolute
