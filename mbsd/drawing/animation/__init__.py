"""The skeleton in motion, with velocities, accelerations, forces, reactions and energy, as MP4 or GIF."""
