"""Building a mechanism in space by name; each method stands beside its kind."""

from __future__ import annotations

from mbsd.spatial.model.drivers import drive_distance, drive_slide, drive_turn
from mbsd.spatial.model.events import event
from mbsd.spatial.model.forces.actuator import actuator
from mbsd.spatial.model.forces.bushing import bushing
from mbsd.spatial.model.forces.contact import contact, tyre
from mbsd.spatial.model.forces.drag import drag
from mbsd.spatial.model.forces.friction import friction
from mbsd.spatial.model.forces.spring import spring
from mbsd.spatial.model.forces.torque import torque
from mbsd.spatial.model.forces.torsion_spring import torsion_spring
from mbsd.spatial.model.forces.user_force import user_force
from mbsd.spatial.model.joints.belt import belt
from mbsd.spatial.model.joints.constant_velocity import constant_velocity
from mbsd.spatial.model.joints.cylindrical import cylindrical
from mbsd.spatial.model.joints.differential import differential
from mbsd.spatial.model.joints.distance import distance_joint
from mbsd.spatial.model.joints.fixed import fixed
from mbsd.spatial.model.joints.gear_pair import gear_pair
from mbsd.spatial.model.joints.lock import lock
from mbsd.spatial.model.joints.parallel import parallel
from mbsd.spatial.model.joints.planar import planar
from mbsd.spatial.model.joints.point_on_line import point_on_line
from mbsd.spatial.model.joints.point_on_plane import point_on_plane
from mbsd.spatial.model.joints.prismatic import prismatic
from mbsd.spatial.model.joints.rack_and_pinion import rack_and_pinion
from mbsd.spatial.model.joints.revolute import revolute
from mbsd.spatial.model.joints.rod_with_fork import rod_with_fork
from mbsd.spatial.model.joints.rolling import rolling
from mbsd.spatial.model.joints.screw import screw
from mbsd.spatial.model.joints.spherical import spherical
from mbsd.spatial.model.joints.universal import universal
from mbsd.spatial.model.mechanism import Model


class Building(Model):
    """A model in space with methods that add joints and drivers, and raise an error at once for what is wrong."""

    fixed = fixed
    revolute = revolute
    prismatic = prismatic
    cylindrical = cylindrical
    planar = planar
    spherical = spherical
    universal = universal
    constant_velocity = constant_velocity
    distance = distance_joint
    rod_with_fork = rod_with_fork
    point_on_line = point_on_line
    point_on_plane = point_on_plane
    parallel = parallel
    lock = lock
    screw = screw
    rolling = rolling
    gear_pair = gear_pair
    rack_and_pinion = rack_and_pinion
    belt = belt
    differential = differential

    spring = spring
    torsion_spring = torsion_spring
    torque = torque
    actuator = actuator
    drag = drag
    friction = friction
    bushing = bushing
    contact = contact
    tyre = tyre
    user_force = user_force

    drive_turn = drive_turn
    drive_slide = drive_slide
    drive_distance = drive_distance

    event = event
