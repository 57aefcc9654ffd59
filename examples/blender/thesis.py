# SPDX-License-Identifier: MIT
"""The thesis' scenes in Blender: imports a .glb of `impact gltf`, with lamp, camera and floor, and renders frames.

    ./run gltf examples/scenes/sphere_wall.lua                # out/sphere_wall.glb
    python3 examples/blender/thesis.py out/sphere_wall.glb --frame 25 --out frame.png     # with `pip install bpy`
    blender --background --python examples/blender/thesis.py -- out/sphere_wall.glb       # or Blender itself

Without --frame all frames are rendered; --check compares the imported motion with the keys in the file, and prints the worst;
--compare runs Blender's own rigid bodies from the first frame on, from rest and with 10 and 100 substeps a frame, and prints where they
go beside where the file's go (make one with examples/blender/drop.lua).
The frame rate is set before the import: glTF has seconds, Blender frames, and its importer converts at once.
"""
import argparse
import json
import math
import struct
import sys

import bpy
from mathutils import Quaternion, Vector


def arguments():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:]
    parser = argparse.ArgumentParser(description="a run of libimpact in Blender")
    parser.add_argument("glb")
    parser.add_argument("--frame", type=int)
    parser.add_argument("--out", default="frame_####.png")
    parser.add_argument("--samples", type=int, default=32)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--compare", action="store_true")
    return parser.parse_args(words)


def load(path, rate=24):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = rate
    bpy.ops.import_scene.gltf(filepath=path)
    ends = [action.frame_range[1] for action in bpy.data.actions]
    scene.frame_start, scene.frame_end = 1, max(1, math.ceil(max(ends, default=1)))
    return scene


def keys_of(path):
    """Of each body that moves: name, times, places, quaternions (w first), as the file has them."""
    blob = open(path, "rb").read()
    size = struct.unpack_from("<I", blob, 12)[0]
    head, data = json.loads(blob[20:20 + size]), 28 + size

    def read(number, width):
        accessor = head["accessors"][number]
        at = data + head["bufferViews"][accessor["bufferView"]]["byteOffset"]
        values = struct.unpack_from("<%df" % (width * accessor["count"]), blob, at)
        return [values[i:i + width] for i in range(0, len(values), width)]

    animation = head.get("animations", [{"channels": [], "samplers": []}])[0]
    for place, turn in zip(animation["channels"][::2], animation["channels"][1::2]):
        samplers = [animation["samplers"][channel["sampler"]] for channel in (place, turn)]
        times = [t for (t,) in read(samplers[0]["input"], 1)]
        turns = [(w, x, y, z) for x, y, z, w in read(samplers[1]["output"], 4)]
        yield head["nodes"][place["target"]["node"]]["name"], times, read(samplers[0]["output"], 3), turns


def check(scene, path):
    worst, turned, upright = 0.0, 0.0, Quaternion((1, 0, 0), -math.pi / 2)  # the importer turns meshes from y up to z up
    for name, times, places, turns in keys_of(path):
        body = bpy.data.objects[name]
        for t, x, q in list(zip(times, places, turns))[:: max(1, len(times) // 200)]:
            frame = t * scene.render.fps
            scene.frame_set(math.floor(frame), subframe=frame - math.floor(frame))
            worst = max(worst, (body.matrix_world.translation - Vector(x)).length)
            turned = max(turned, body.matrix_world.to_quaternion().rotation_difference(Quaternion(q) @ upright).angle)
    print("worst of the keys in Blender: %.2g m, %.2g rad" % (worst, abs(min(turned, 2 * math.pi - turned))))


def facts_of(path):
    """Of each body: what the file says of its shape, mass, friction and restitution."""
    blob = open(path, "rb").read()
    nodes = json.loads(blob[20:20 + struct.unpack_from("<I", blob, 12)[0]])["nodes"]
    return {node["name"]: node["extras"] for node in nodes if "extras" in node}


def own_bodies(path, substeps):
    """Blender's rigid bodies where the file's begin: places by frame and body."""
    scene, facts = load(path), facts_of(path)
    scene.frame_start = 0  # where the file's time begins
    scene.frame_set(0)
    bpy.ops.rigidbody.world_add()
    scene.rigidbody_world.substeps_per_frame = substeps
    scene.rigidbody_world.point_cache.frame_start, scene.rigidbody_world.point_cache.frame_end = 0, scene.frame_end
    for body in [o for o in scene.objects if o.name in facts]:
        here, fact = body.matrix_world.copy(), facts[body.name]
        body.parent = None
        body.animation_data_clear()
        body.matrix_world = here
        with bpy.context.temp_override(object=body, active_object=body, selected_objects=[body]):
            bpy.ops.rigidbody.object_add(type="ACTIVE" if "mass" in fact else "PASSIVE")
        own = body.rigid_body
        own.collision_shape = {"sphere": "SPHERE", "plane": "MESH"}.get(fact["shape"], "CONVEX_HULL")
        own.use_margin, own.collision_margin = True, 0.0
        own.mass, own.friction, own.restitution = fact.get("mass", 1), fact["friction"], fact["restitution"]
        own.linear_damping = own.angular_damping = 0.0
        own.use_deactivation = False
    return places_of(scene, [name for name in facts if "mass" in facts[name]])


def places_of(scene, names):
    places = []
    for frame in range(scene.frame_end + 1):
        scene.frame_set(frame)
        places.append({name: scene.objects[name].matrix_world.translation.copy() for name in names})
    return places


def rebound(heights):
    """The highest after the first turn upwards."""
    turn = next((k for k in range(len(heights) - 1) if heights[k + 1] > heights[k] + 1e-6), len(heights) - 1)
    return max(heights[turn:])


def compare(scene, path):
    names = [name for name, fact in facts_of(path).items() if "mass" in fact]
    rate, ours = scene.render.fps, places_of(scene, names)
    few, many = own_bodies(path, 10), own_bodies(path, 100)
    print("t, s    body                 z, m     Blender, 10   100 substeps   differences, m")
    for k in range(0, len(ours), max(1, len(ours) // 16)):
        for name in names:
            off = [(other[k][name] - ours[k][name]).length for other in (few, many)]
            print("%6.3f  %-16s %9.5f %12.5f %12.5f %11.5f %9.5f" % (k / rate, name, ours[k][name].z, few[k][name].z, many[k][name].z, *off))
    for name in names:
        print("%s comes back to z = %.4f m, Blender's to %.4f (10 substeps) and %.4f (100), as frames show it" % (
            name, *(rebound([p[name].z for p in way]) for way in (ours, few, many))))


def light_and_camera(scene):
    corners = [o.matrix_world @ Vector(c) for o in scene.objects if o.animation_data for c in o.bound_box]
    middle = sum(corners, Vector()) / max(1, len(corners))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle, sun.rotation_euler = 4.0, 0.05, (0.5, -0.6, 0)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = middle + Vector((-1.5, -6, 2.2))
    camera.rotation_euler = (Vector((1.2, 0, -0.3)) + middle - camera.location).to_track_quat("-Z", "Y").to_euler()
    for thing in (sun, camera):
        scene.collection.objects.link(thing)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    color, strength = scene.world.node_tree.nodes["Background"].inputs[:2]
    color.default_value, strength.default_value = (0.75, 0.8, 0.9, 1), 0.5


def main():
    given = arguments()
    scene = load(given.glb)
    if given.check:
        return check(scene, given.glb)
    if given.compare:
        return compare(scene, given.glb)
    light_and_camera(scene)
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", given.samples, False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.filepath = 960, 600, given.out
    if given.frame is not None:
        scene.frame_set(given.frame)
    bpy.ops.render.render(animation=given.frame is None, write_still=True)


main()
