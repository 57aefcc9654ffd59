# SPDX-License-Identifier: MIT
"""The thesis' scenes in Blender: imports a .glb of `impact gltf`, with lamp and camera, and renders its frames.

    ./run gltf examples/scenes/sphere_wall.lua                # out/sphere_wall.glb
    python3 examples/blender/thesis.py out/sphere_wall.glb --frame 25 --out frame.png     # with `pip install bpy`
    blender --background --python examples/blender/thesis.py -- out/sphere_wall.glb       # or Blender itself

--check compares the imported motion with the keys in the file; --states with the run's own, and it fails where they are further apart than the
file says. The frame rate is the one that the file is for (`impact gltf --frame-rate 240`), of which 24 frames a second are rendered. --compare runs Blender's own rigid bodies from the same start, with 10 and
100 substeps a frame, and prints where they go beside where the file's go (examples/blender/drop.lua has a known answer; the thesis' two
spheres: out/two_spheres.glb --compare --wind left 25 5 --wind right -25 5)."""
import argparse
import os
import sys

import bpy
from mathutils import Vector

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
import beside


def render(scene, frame, path, samples):
    moved = [o.matrix_world @ Vector(c) for o in scene.objects if o.animation_data for c in o.bound_box]
    middle = sum(moved, Vector()) / max(1, len(moved))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle, sun.rotation_euler = 4.0, 0.05, (0.5, -0.6, 0)
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.camera.location = middle + Vector((-1.5, -6, 2.2))
    scene.camera.rotation_euler = Vector((2.7, 6, -2.5)).to_track_quat("-Z", "Y").to_euler()
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.4, 0.43, 0.48, 1)
    for thing in (sun, scene.camera):
        scene.collection.objects.link(thing)
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", samples, False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.filepath = 960, 600, path
    scene.frame_set(frame or 0)
    bpy.ops.render.render(animation=frame is None, write_still=True)


parser = argparse.ArgumentParser(description="a run of libimpact in Blender")
parser.add_argument("glb")
parser.add_argument("--frame", type=int)
parser.add_argument("--out", default="frame_####.png")
parser.add_argument("--samples", type=int, default=32)
parser.add_argument("--check", action="store_true")
parser.add_argument("--states", help="with --check: a CSV of the run's own states (tests/view/states.lua)")
parser.add_argument("--compare", action="store_true")
parser.add_argument("--wind", nargs=3, action="append", default=[], metavar=("BODY", "N", "M"), help="along x from the body's start, for --compare")
given = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:])
scene = beside.load(given.glb)
if given.check:
    beside.check(scene, given.glb)
    if given.states and not beside.against(scene, given.states, given.glb):
        sys.exit("further off in Blender than the file says")
elif given.compare:
    beside.compare(scene, given.glb, given.wind)
else:
    render(scene, given.frame, given.out, given.samples)
