# SPDX-License-Identifier: MIT
"""What Blender makes of a file of `impact gltf`: the imported poses against the file's keys; its own rigid bodies beside the file's.
For thesis.py --check and --compare."""
import json
import math
import struct

import bpy
from mathutils import Quaternion, Vector

SHOWN = 24  # frames a second that are rendered, and at which Blender's own bodies move


def load(path, rate=None):
    """Imports at the frame rate that the file is for (`--frame-rate`), or this one: it is set before the import, which turns glTF's seconds
    into frames; every so many of them are rendered."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = round(rate or open_glb(path)[0]["scenes"][0]["extras"]["frame_rate"])
    scene.frame_step = max(1, scene.render.fps // SHOWN)
    bpy.ops.import_scene.gltf(filepath=path)
    scene.frame_start, scene.frame_end = 0, math.ceil(max((a.frame_range[1] for a in bpy.data.actions), default=1))
    return scene


def go_to(scene, t):
    frame = t * scene.render.fps
    scene.frame_set(math.floor(frame), subframe=frame % 1)


def open_glb(path):
    """The file's JSON, and a function that reads the rows of one of its accessors."""
    blob = open(path, "rb").read()
    size = struct.unpack_from("<I", blob, 12)[0]
    head = json.loads(blob[20:20 + size])

    def rows(number, width):
        accessor = head["accessors"][number]
        at = 28 + size + head["bufferViews"][accessor["bufferView"]]["byteOffset"]
        return list(struct.iter_unpack("<%df" % width, blob[at:at + 4 * width * accessor["count"]]))
    return head, rows


def check(scene, path):
    (head, rows), upright = open_glb(path), Quaternion((1, 0, 0), -math.pi / 2)  # the importer turns meshes from y up to z up
    place, angle = 0.0, 0.0
    for animation in head.get("animations", []):
        for moved, turned in zip(animation["channels"][::2], animation["channels"][1::2]):
            body = bpy.data.objects[head["nodes"][moved["target"]["node"]]["name"]]
            first, second = (animation["samplers"][channel["sampler"]] for channel in (moved, turned))
            keys = list(zip(rows(first["input"], 1), rows(first["output"], 3), rows(second["output"], 4)))
            for (a, b) in list(zip(keys, keys[1:]))[:: max(1, len(keys) // 200)]:
                for part in (0, 0.5):  # at a key, and half-way to the next
                    t = a[0][0] + part * (b[0][0] - a[0][0])
                    ends = [Quaternion((w, i, j, k)) for i, j, k, w in (a[2], b[2])]
                    go_to(scene, t)
                    turn = body.matrix_world.to_quaternion().rotation_difference(ends[0].slerp(ends[1], part) @ upright)
                    place = max(place, (body.matrix_world.translation - Vector(a[1]).lerp(Vector(b[1]), part)).length)
                    angle = max(angle, 2 * math.atan2(Vector(turn[1:]).length, abs(turn.w)))
    print("worst of keys and half-way between in Blender: %.2g m, %.2g rad" % (place, angle))


def against(scene, path, glb):
    """The same beside the run itself: rows of t, body, size, place and orientation at any times (tests/view/states.lua). Whether they are
    within what the file says that they are."""
    file = open_glb(glb)[0]["scenes"][0]["extras"]
    upright, place, angle, count = Quaternion((1, 0, 0), -math.pi / 2), 0.0, 0.0, 0
    for line in open(path).read().splitlines()[1:]:
        words = line.split(",")
        t, size, x, y, z, *q = (float(word) for word in words[:1] + words[2:])
        body = bpy.data.objects[words[1]]
        go_to(scene, t)
        turn = body.matrix_world.to_quaternion().rotation_difference(Quaternion(q) @ upright)
        place = max(place, (body.matrix_world.translation - Vector((x, y, z))).length / size)
        angle = max(angle, 2 * math.atan2(Vector(turn[1:]).length, abs(turn.w)))
        count += 1
    print("worst of %d states of the run in Blender, at %d frames a second: %.3g of a body, %.3g rad" % (count, scene.render.fps, place, angle))
    return max(place, angle) <= max(file["tolerance"], file["off"])


def places(scene, names):
    """Of every frame where these bodies are."""
    run = []
    for frame in range(scene.frame_end + 1):
        scene.frame_set(frame)
        run.append([scene.objects[name].matrix_world.translation.copy() for name in names])
    return run


def blow(body, force, reach):
    """A wind of so many N along x from where the body is, as far as that; a field's strength is N by the frame's rate."""
    turn = (0, math.copysign(math.pi / 2, force), 0)
    bpy.ops.object.effector_add(type="WIND", location=body.matrix_world.translation, rotation=turn)
    field = bpy.context.object.field
    field.strength, field.flow, field.noise, field.falloff_power = abs(force) * SHOWN, 0, 0, 0
    field.use_max_distance, field.distance_max = True, reach


def own_run(path, facts, names, substeps, winds):
    """The same of Blender's own rigid bodies, begun where the file's are."""
    scene = load(path, SHOWN)
    scene.frame_set(0)
    bpy.ops.rigidbody.world_add()
    scene.rigidbody_world.substeps_per_frame = substeps
    scene.rigidbody_world.point_cache.frame_start, scene.rigidbody_world.point_cache.frame_end = 0, scene.frame_end
    for body in [scene.objects[name] for name in facts]:
        here, fact = body.matrix_world.copy(), facts[body.name]
        body.parent = None
        body.animation_data_clear()
        body.matrix_world = here
        with bpy.context.temp_override(object=body, active_object=body, selected_objects=[body]):
            bpy.ops.rigidbody.object_add(type="ACTIVE" if "mass" in fact else "PASSIVE")
        own = body.rigid_body
        own.collision_shape = {"sphere": "SPHERE", "plane": "MESH"}.get(fact["shape"], "CONVEX_HULL")
        own.mass, own.friction, own.restitution = fact.get("mass", 1), fact["friction"], fact["restitution"]
        own.use_margin, own.collision_margin, own.linear_damping, own.angular_damping, own.use_deactivation = True, 0, 0, 0, False
    for name, force, reach in winds:
        blow(bpy.data.objects[name], float(force), float(reach))
    return places(scene, names)


def rebound(heights):
    turn = next((k for k in range(len(heights) - 1) if heights[k + 1] > heights[k] + 1e-6), len(heights) - 1)
    return max(heights[turn:])


def compare(scene, path, winds):
    scene = load(path, SHOWN)
    facts = {node["name"]: node["extras"] for node in open_glb(path)[0]["nodes"] if "extras" in node}
    names = [name for name in facts if "mass" in facts[name]]
    ours, few, many = places(scene, names), own_run(path, facts, names, 10, winds), own_run(path, facts, names, 100, winds)
    print("t, s    body                 z, m     Blender, 10   100 substeps   apart, m")
    for k in range(0, len(ours), max(1, len(ours) // 16)):
        for name, a, b, c in zip(names, ours[k], few[k], many[k]):
            print("%6.3f  %-16s %9.5f %12.5f %12.5f %11.5f %9.5f" % (k / SHOWN, name, a.z, b.z, c.z, (b - a).length, (c - a).length))
    for i, name in enumerate(names):
        heights = tuple(rebound([frame[i].z for frame in run]) for run in (ours, few, many))
        print("%s comes back to z = %.4f m, Blender's to %.4f (10 substeps) and %.4f (100), as frames show it" % ((name,) + heights))
