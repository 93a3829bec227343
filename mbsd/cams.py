"""Cams: lift laws, and the disc's outline for each kind of follower; the door to mbsd/model/cams.

from mbsd.cams import Lift, roller_cam
lift = Lift.of((math.pi / 2, 0.02, "cycloidal"), (math.pi / 2, 0.02), (math.pi, 0.0, "3-4-5"))
cam = roller_cam(lift, base_radius=0.04, roller_radius=0.01)
m.cam_roller("contact", disc.origin, follower.origin, cam)
"""

from mbsd.model.cams.followers import cam_from, flat_cam, oscillating_flat_cam, oscillating_roller_cam, roller_cam
from mbsd.model.cams.lift import RISES, Lift
from mbsd.model.cams.profile import CamProfile

__all__ = [
    "RISES",
    "CamProfile",
    "Lift",
    "cam_from",
    "flat_cam",
    "oscillating_flat_cam",
    "oscillating_roller_cam",
    "roller_cam",
]
