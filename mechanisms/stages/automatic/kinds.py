"""Every kind of joint, force and contact that has parts by itself: importing a line's module enters it."""
