# SPDX-License-Identifier: Apache-2.0
"""A glTF document that grows, and its text."""

import base64
import json
import math
import struct

from solids import newell
from vectors import axis_angle, looking, rounded, unit


class Document:
    def __init__(self, name, frames, about, digits=6, double_sided=False):
        """`about` is the line by which `kage list` describes the scene. Positions get `digits` after the point. With 6, corners of a face lie off its plane by nearly what kage allows;
        with 8, no further than single precision takes them. `double_sided`: faces are meant to be seen from behind too."""
        self.double_sided = double_sided
        self.digits = digits
        self.bytes = bytearray()
        self.json = {
            "asset": {
                "version": "2.0",
                "generator": "kage scenes/make",
                "copyright": "kage, Apache-2.0",
                "extras": {"kage": {"about": about, "frames": frames}},
            },
            "scene": 0,
            "scenes": [{"name": name, "nodes": []}],
            "nodes": [],
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }
        self.materials = {}

    def material(self, color):
        """A fourth number is alpha: the material is translucent."""
        key = tuple(rounded(color))
        if key not in self.materials:
            self.materials[key] = len(self.json["materials"])
            material = {
                "pbrMetallicRoughness": {
                    "baseColorFactor": list(key[:3]) + [key[3] if len(key) > 3 else 1],
                    "metallicFactor": 0,
                    "roughnessFactor": 1,
                }
            }
            if len(key) > 3:
                material["alphaMode"] = "BLEND"
            if self.double_sided:
                material["doubleSided"] = True
            self.json["materials"].append(material)
        return self.materials[key]

    def accessor(self, values, kind, form, component, bounds=False):
        """Append values (a list of tuples) to the buffer. `form` is struct's letter."""
        while len(self.bytes) % 4:
            self.bytes.append(0)
        start = len(self.bytes)
        for v in values:
            self.bytes += struct.pack("<%d%s" % (len(v), form), *v)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": start, "byteLength": len(self.bytes) - start})
        a = {
            "bufferView": len(self.json["bufferViews"]) - 1,
            "componentType": component,
            "count": len(values),
            "type": kind,
        }
        if bounds:
            single = [struct.unpack("<%df" % len(v), struct.pack("<%df" % len(v), *v)) for v in values]
            a["min"] = [min(v[k] for v in single) for k in range(len(single[0]))]
            a["max"] = [max(v[k] for v in single) for k in range(len(single[0]))]
        self.json["accessors"].append(a)
        return len(self.json["accessors"]) - 1

    def primitive(self, points, triangles, color, normals=None, colors=None):
        attributes = {"POSITION": self.accessor([rounded(p, self.digits) for p in points], "VEC3", "f", 5126, True)}
        if normals:
            attributes["NORMAL"] = self.accessor([rounded(n) for n in normals], "VEC3", "f", 5126)
        if colors:
            attributes["COLOR_0"] = self.accessor([rounded(c) for c in colors], "VEC3", "f", 5126)
        flat = [(i,) for t in triangles for i in t]
        return {
            "attributes": attributes,
            "indices": self.accessor(flat, "SCALAR", "H", 5123),
            "material": self.material(color),
        }

    def flat(self, faces, color):
        """Faces with a normal each."""
        points, normals, triangles = [], [], []
        for f in faces:
            first = len(points)
            n = unit(newell(f))
            points += f
            normals += [n] * len(f)
            triangles += [(first, first + i, first + i + 1) for i in range(1, len(f) - 1)]
        return self.primitive(points, triangles, color, normals)

    def mesh(self, name, *primitives):
        self.json["meshes"].append({"name": name, "primitives": list(primitives)})
        return len(self.json["meshes"]) - 1

    def node(self, name, **members):
        members = {k: rounded(v, 7) if isinstance(v, tuple) else v for k, v in members.items()}
        self.json["nodes"].append(dict(name=name, **members))
        number = len(self.json["nodes"]) - 1
        self.json["scenes"][0]["nodes"].append(number)
        return number

    def solid(self, name, faces, color, at=(0, 0, 0), turn=None):
        members = {"mesh": self.mesh(name, self.flat(faces, color)), "translation": tuple(at)}
        if turn:
            members["rotation"] = axis_angle(*turn)
        return self.node(name, **members)

    def sun(self, direction, color=(1, 1, 1)):
        self.lamp(
            {"type": "directional", "color": list(color), "name": "sun"}, rotation=looking(direction, (0.1, 1, 0.2))
        )

    def lamp(self, light, **members):
        self.json["extensionsUsed"] = ["KHR_lights_punctual"]
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        return self.node(light["name"], extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **members)

    def camera(self, camera, **members):
        self.json["cameras"] = [dict(camera, name="camera")]
        return self.node("camera", camera=0, **members)

    def animate(self, node, times, **paths):
        """Linear keys; paths: translation=[...], rotation=[...]."""
        input_ = self.accessor([(t,) for t in times], "SCALAR", "f", 5126, True)
        samplers, channels = [], []
        for path, values in paths.items():
            kind = "VEC4" if path == "rotation" else "VEC3"
            output = self.accessor([rounded(v) for v in values], kind, "f", 5126)
            channels.append({"sampler": len(samplers), "target": {"node": node, "path": path}})
            samplers.append({"input": input_, "output": output, "interpolation": "LINEAR"})
        if "animations" not in self.json:
            self.json["animations"] = [{"channels": [], "samplers": []}]
        whole = self.json["animations"][0]
        for c in channels:
            c["sampler"] += len(whole["samplers"])
        whole["channels"] += channels
        whole["samplers"] += samplers

    def text(self):
        data = base64.b64encode(bytes(self.bytes)).decode("ascii")
        out = {k: v for k, v in self.json.items() if v != []}
        out["buffers"] = [{"byteLength": len(self.bytes), "uri": "data:application/octet-stream;base64," + data}]
        # One line for each element of the top-level arrays: short, and a change shows where it is.
        lines = []
        for key in sorted(out):
            value = out[key]
            if isinstance(value, list) and value and isinstance(value[0], dict):
                rows = ",\n".join("  " + json.dumps(v, sort_keys=True) for v in value)
                lines.append(f'"{key}": [\n{rows}\n]')
            else:
                lines.append(f'"{key}": {json.dumps(value, sort_keys=True)}')
        return "{\n" + ",\n".join(lines) + "\n}\n"


def perspective(degrees, near, far=None):
    view = {"yfov": round(math.radians(degrees), 7), "aspectRatio": 1.333333, "znear": near}
    if far:
        view["zfar"] = far
    return {"type": "perspective", "perspective": view}
