# SPDX-License-Identifier: MIT
"""The thesis' scenes in Blender: imports a .glb of `impact gltf`, with lamp, camera and floor, and renders frames.

    ./run gltf examples/scenes/sphere_wall.lua                # out/sphere_wall.glb
    python3 examples/blender/thesis.py out/sphere_wall.glb --frame 25 --out frame.png     # with `pip install bpy`
    blender --background --python examples/blender/thesis.py -- out/sphere_wall.glb       # or Blender itself

Without --frame all frames are rendered; --check compares the imported motion with the keys in the file, and prints the worst.
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
    light_and_camera(scene)
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", given.samples, False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.filepath = 960, 600, given.out
    if given.frame is not None:
        scene.frame_set(given.frame)
    bpy.ops.render.render(animation=given.frame is None, write_still=True)


main()
