"""The scene in Blender: the studio, the mechanism, and its motion."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from render.blender.job import Job
from render.blender.scene import arrows, cut, materials, pieces, tubes
from render.blender.scene.world import bench, ground, lights
from render.blender.scene.world.bench import Thing
from render.film.framing import SENSOR
from render.film.framing import studio as studio_axes
from render.film.scene import Point, State, StudioSpec
from render.looks import Light
from shared.contract.parts import Z

# The place where a machine is filmed: ground, background, sky and lights of its look. Sized by what is filmed, turned
# with the camera.
#
# Places are (right, away, up) as the camera stands, in radii of the swept motion around its middle. A light's power
# grows with the square of its distance, so a mechanism of any size is lit alike.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


BESIDE = 0.35
"""From what the machine reaches to the things beside it, in radii."""


def build_studio(scene: Any, studio: StudioSpec) -> None:
    """Put the look around the mechanism and set the view."""
    look, stands = studio.look, studio.up != Z
    lights.build(scene, look.sky, studio.up)
    light = look.standing if stands else look.lying
    things = [
        ground.build(scene, studio, light.bounce),
        *(lights.softbox(scene, studio, box) for box in light.softboxes),
    ]
    if light.sun is not None:
        things += lights.sun(scene, studio, light.sun)
    if studio.wall is not None and (look.wall is None or look.wall.kind == "sweep"):
        things.append(ground.wall(scene, studio))
    things += _workshop(scene, studio, light)
    if stands:
        for thing in things:
            thing.matrix_world = to_world(studio.up) @ thing.matrix_basis
    view = scene.view_settings
    view.view_transform = "AgX"
    view.look = look.contrast
    view.exposure = look.exposure


def to_world(up: Point) -> Any:
    """Return the matrix that turns the studio's axes into those of the world (4 x 4)."""
    from mathutils import Matrix

    return Matrix(studio_axes(up).T.tolist()).to_4x4()


def _workshop(scene: Any, studio: StudioSpec, light: Light) -> list[Any]:
    """Return the things of a bench, where the machine does not reach: a wall with tools and a vice."""
    from mathutils import Matrix, Vector

    look, radius = studio.look, studio.radius
    right, away = studio.reach
    floor = Vector((studio.centre[0], studio.centre[1], studio.floor))
    made = []
    if look.wall is not None and look.wall.kind == "pegboard":
        made.append(Thing(scene, "pegboard", radius, floor, studio.azimuth if studio.wall is None else 0.0))
        behind = away / radius + look.wall.away
        if studio.wall is not None:
            behind = (studio.wall - studio.centre[1]) / radius
        lamps = lights.lamps_seen_from(made[-1].root, studio, light.softboxes)
        bench.build_pegboard(made[-1], look.wall.colour, behind, right / radius, light.bounce, lamps)
    if look.vice and studio.wall is None:
        turn = Matrix.Rotation(studio.azimuth, 4, "Z")
        place = turn @ Vector((-0.62 * right, away + BESIDE * radius, 0.0))
        made.append(Thing(scene, "vice", radius, floor + place, studio.azimuth + 0.5))
        made[-1].seen_only = True
        bench.build_vice(made[-1], lights.lamps_seen_from(made[-1].root, studio, light.softboxes))
    return [thing.root for thing in made]


# The whole scene in Blender is built once and then played. Frame i of the timeline shows state i.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


PINHOLE = 1000.0
"""f-stop of a camera without a lens blur."""
NEAR, FAR = 0.01, 1000.0
"""Field of a camera, in radii of the machine."""


@dataclass
class BuiltScene:
    """The built scene and its moving things."""

    job: Job
    scene: Any
    bodies: dict[str, Any]
    trails: list[Any]
    tubes: list[Any]
    solids: dict[str, Any] = field(default_factory=dict)
    """Pieces by ``body/piece``."""
    texts: list[Any] = field(default_factory=list)
    front: Any = None
    """The scene of what is drawn over the picture: arrows, on nothing; None where there are none."""
    arcs: list[Any] = field(default_factory=list)
    """In that scene."""
    beside: list[Any] = field(default_factory=list)
    """Objects that states may hide; empty if none does."""

    def show(self, index: int) -> None:
        """Go to state ``index``."""
        self.scene.frame_set(index)
        if self.front is not None:
            self.front.frame_set(index)
        for which, thing in enumerate(self.trails):
            path = self.job.states[index].trails[which]
            tubes.place_trail(thing, path, self.job.scene.trails[which].radius)
        for which, thing in enumerate(self.tubes):
            tubes.place_tube(thing, self.job.states[index].tubes[which], self.job.scene.tubes[which].radius)
        for thing in self.beside:
            hidden = self.job.states[index].hidden
            thing.hide_render = hidden == "all" or (hidden == "trails" and thing in self.trails)
        for which, thing in enumerate(self.arcs):
            arrows.place_arc(thing, self.job.scene.arcs[which], *self.job.states[index].arcs[which])


def build_scene(job: Job) -> BuiltScene:
    """Turn an empty Blender into the studio with the mechanism in it, with the motion on its timeline."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.unit_settings.system = "METRIC"
    solids: dict[str, Any] = {}
    bodies = pieces.build_pieces(scene, job.scene.pieces, job.scene.studio.radius, job.flat, solids)
    camera = _camera(scene, job)
    texts: list[Any] = []
    trails: list[Any] = []
    wires: list[Any] = []
    if job.flat is None:
        if not job.drawn:
            build_studio(scene, job.scene.studio)
        trails = [tubes.build_trail(scene, spec) for spec in job.scene.trails]
        wires = [tubes.build_tube(scene, spec, job.scene.studio.radius) for spec in job.scene.tubes]
        texts = [pieces.build_label(scene, spec) for spec in job.scene.labels]
    if job.flat is not None or job.drawn:
        _dark(scene)
    if job.drawn:
        meshes = [thing for thing in scene.objects if thing.type == "MESH" and thing not in trails]
        materials.number(meshes, [*trails, *texts], job.scene.studio.radius)
    painted = job.flat is None and not job.drawn
    cut.cut_in_passing(scene, job.scene, solids, painted)
    if wires:
        cut.cut_tubes(scene, job.scene, job.states, wires, painted)
    _animate(job, bodies, camera, texts)
    _lift(job, solids)
    drawn = (job.scene.arrows or job.scene.arcs) and job.flat is None
    front = _front(job, camera) if drawn else None
    curved = [arrows.build_arc(front, spec) for spec in job.scene.arcs] if drawn else []
    scene.frame_start, scene.frame_end = 0, len(job.states) - 1
    scene.render.fps = job.scene.fps
    beside = [*trails, *wires, *texts] if any(state.hidden for state in job.states) else []
    return BuiltScene(job, scene, bodies, trails, wires, solids, texts, front, curved, beside)


def _front(job: Job, camera: Any) -> Any:
    """Return a scene with the arrows alone, seen by the same camera without its lens blur: nothing hides them."""
    import bpy

    front = bpy.data.scenes.new("arrows")
    front.render.engine = "CYCLES"
    front.render.film_transparent = True
    front.view_settings.view_transform = "Standard"
    eye = camera.copy()
    eye.data = camera.data.copy()
    eye.data.dof.use_dof = False
    front.collection.objects.link(eye)
    front.camera = eye
    front.frame_start, front.frame_end = 0, len(job.states) - 1
    made = [arrows.build_arrow(front, spec) for spec in job.scene.arrows]
    for index, arrow in enumerate(made):
        tails, tips = (np.array([state.arrows[index][end] for state in job.states]) for end in (0, 1))
        for thing, path, channels in arrows.channels(arrow, job.scene.arrows[index], tails, tips):
            _key(thing, path, channels)
    return front


def bake_shapes(built: BuiltScene) -> None:
    """Give each trail, tube and arc a shape per frame, so that a saved scene plays them."""
    scene, states = built.job.scene, built.job.states
    for which, thing in enumerate(built.trails):
        radius = scene.trails[which].radius
        _bake(thing, [tubes.trail_vertices(state.trails[which], radius) for state in states])
    for which, thing in enumerate(built.tubes):
        radius = scene.tubes[which].radius
        _bake(thing, [tubes.tube_vertices(state.tubes[which], radius) for state in states])
    for which, thing in enumerate(built.arcs):
        _bake(thing, [arrows.arc_vertices(scene.arcs[which], *state.arcs[which]) for state in states])


def _bake(thing: Any, shapes: list[np.ndarray]) -> None:
    thing.data.vertices.foreach_set("co", shapes[0].ravel())
    thing.data.update()
    for shape in shapes:
        block = thing.shape_key_add(from_mix=False)
        block.interpolation = "KEY_LINEAR"
        block.data.foreach_set("co", shape.ravel())
    keys = thing.data.shape_keys
    keys.use_relative = False
    _key(keys, "eval_time", [np.array([block.frame for block in keys.key_blocks])], "OBJECT")


def _camera(scene: Any, job: Job) -> Any:
    """Set the camera. What is not keyed follows from the scene alone: a picture is the same whatever its job
    renders.
    """
    import bpy

    pose, radius = job.states[0].camera, job.scene.studio.radius
    lens = bpy.data.cameras.new("camera")
    lens.sensor_fit, lens.sensor_width, lens.lens = "AUTO", SENSOR, pose.lens
    lens.clip_start, lens.clip_end = NEAR * radius, FAR * radius
    lens.dof.use_dof = True
    lens.dof.focus_distance = pose.focus
    lens.dof.aperture_fstop = _stop(pose)
    camera = bpy.data.objects.new("camera", lens)
    scene.collection.objects.link(camera)
    scene.camera = camera
    return camera


def _stop(pose: Any) -> float:
    """Return the f-stop of a camera that stands among others that have one."""
    return max(pose.fstop, 0.01) if pose.fstop > 0 else PINHOLE


def _dark(scene: Any) -> None:
    """Show nothing but the flat colours: no world, no lens blur, no view transform."""
    import bpy

    scene.world = bpy.data.worlds.new("dark")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes.clear()
    scene.camera.data.dof.use_dof = False
    scene.view_settings.view_transform = "Raw"


def _animate(job: Job, bodies: dict[str, Any], camera: Any, texts: list[Any]) -> None:
    """Set linear keys at every frame; signs of quaternions go on, so nothing turns the wrong way round."""
    states = job.states
    for name, thing in bodies.items():
        poses = np.array([state.bodies[name] for state in states])
        thing.rotation_mode = "QUATERNION"
        _key(thing, "location", list(poses[:, :3].T))
        _key(thing, "rotation_quaternion", list(arrows.going_on(poses[:, 3:]).T))
    facing = _facing(states)
    _key(camera, "location", list(np.array([state.camera.position for state in states]).T))
    _key(camera, "rotation_euler", facing)
    lenses = [state.camera for state in states]
    _key(camera.data, "dof.focus_distance", [np.array([pose.focus for pose in lenses])], "CAMERA")
    _key(camera.data, "dof.aperture_fstop", [np.array([_stop(pose) for pose in lenses])], "CAMERA")
    _key(camera.data, "lens", [np.array([pose.lens for pose in lenses])], "CAMERA")
    for index, thing in enumerate(texts):
        _key(thing, "location", list(np.array([state.labels[index] for state in states]).T))
        _key(thing, "rotation_euler", facing)


def _lift(job: Job, solids: dict[str, Any]) -> None:
    """Set keys of pieces that are ever lifted from where they belong."""
    for name in sorted({name for state in job.states for name in state.lifts} & set(solids)):
        heights = np.array([state.lifts.get(name, 0.0) for state in job.states])
        _key(solids[name], "location", [np.zeros(len(heights)), np.zeros(len(heights)), heights])


def _facing(states: list[State]) -> list[np.ndarray]:
    """Return three angles (T,) of the camera; what faces it has the same."""
    tilt = np.array([math.pi / 2 - state.camera.elevation for state in states])
    turn = np.array([state.camera.azimuth for state in states])
    up = states[0].camera.up
    if up == Z:
        return [tilt, np.zeros(len(states)), turn]
    from mathutils import Euler

    facing = [Euler((tilt[0], 0.0, turn[0]))]
    for a, b in zip(tilt, turn, strict=True):
        turned = to_world(up) @ Euler((a, 0.0, b)).to_matrix().to_4x4()
        facing.append(turned.to_euler("XYZ", facing[-1]))
    return list(np.array([list(angles) for angles in facing[1:]]).T)


def _key(thing: Any, path: str, channels: list[np.ndarray], slot: str = "OBJECT") -> None:
    """Key a property at frames 0, 1, 2...; a channel that never changes is set and not keyed."""
    if all(np.ptp(channel) == 0 for channel in channels):
        owner, _, attribute = path.rpartition(".")
        target = thing.path_resolve(owner) if owner else thing
        first = [float(channel[0]) for channel in channels]
        setattr(target, attribute, first if len(first) > 1 else first[0])
        return
    import bpy
    from bpy_extras import anim_utils

    data = thing.animation_data or thing.animation_data_create()
    if data.action is None:
        data.action = bpy.data.actions.new(thing.name)
        data.action_slot = data.action.slots.new(id_type=thing.id_type, name=thing.name)
    bag = anim_utils.action_ensure_channelbag_for_slot(data.action, data.action_slot)
    for index, channel in enumerate(channels):
        curve = bag.fcurves.new(path, index=index)
        count = len(channel)
        curve.keyframe_points.add(count)
        curve.keyframe_points.foreach_set("co", np.column_stack([np.arange(count), channel]).ravel())
        linear = bpy.types.Keyframe.bl_rna.properties["interpolation"].enum_items["LINEAR"].value
        curve.keyframe_points.foreach_set("interpolation", [linear] * count)
        curve.extrapolation = "CONSTANT"
        curve.update()
