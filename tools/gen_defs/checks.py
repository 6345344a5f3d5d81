# SPDX-License-Identifier: Apache-2.0
"""Assumptions of the RTL about rtl/defs/kage.yaml: a definition that breaks one is refused."""

from files import SOURCE


def refuse(what):
    raise SystemExit(f"{SOURCE}: {what}")


def constants_hold(d, params):
    """Numbers fit into the widths that no parameter changes, and the kinds of a level are numbered without a gap."""
    most = {
        "line_number_bits": (d["max_height"], "lines of a frame"),
        "unit_number_bits": (max(p["max"] for p in params if p["name"] == "UNITS") - 1, "UNITS"),
        "code_bits": (max(e["code"] for e in d["errors"]), "errors"),
        "kind_bits": (max(t["code"] for t in d["tokens"]), "kinds"),
    }
    for level in ("spans", "polygons"):
        codes = sorted(t["code"] for t in d["tokens"] if t["level"] in ("", level))
        if codes != list(range(1, len(codes) + 1)):
            refuse(f"tokens: kinds of the level {level} are not numbered from 1 without a gap")
    for name, (value, what) in most.items():
        if value >> d[name]:
            refuse(f"constants: {name}: {what} do not fit")


def same_entry(d):
    """A unit's table takes FACE's fields from index on in one piece."""
    face, entry = (
        [f["name"] for one in d[of] if one["name"] == name for f in one["fields"]]
        for of, name in (("tokens", "FACE"), ("words", "entry"))
    )
    if face[face.index("index") :] != entry:
        refuse("words: entry: is not FACE from index on")


def same_pixel(d, fields, most):
    """The C interface has the fields of a pixel's state, and of repeated ones as many numbers as any configuration."""
    of_word = [f["name"] for word in d["words"] if word["name"] == "pixel" for f in word["fields"]]
    names = [f["name"] + ("s" if f["of"] == "LIGHTS" else "") for f in fields]
    if names != of_word or any(f["times"] != most.get(f["of"], 1) for f in fields):
        refuse("golden_pixel: has other fields than words: pixel, or not as many as there can be")


def same_place(d, name, beside):
    """All tokens with a field `beside` have the field `name`, where they have it, at one place and of one width. The name of
    the first of these tokens."""
    first = None
    for token in d["tokens"]:
        names = [f["name"] for f in token["fields"]]
        if name not in names or beside not in names:
            continue
        place = [(str(f["bits"]), f["repeat"]) for f in token["fields"][: names.index(name) + 1]]
        first = first or (token["name"], place)
        if place != first[1]:
            refuse(f"tokens: {token['name']}: {name} is elsewhere, or of another width, than in {first[0]}")
    return first[0]


def holds_parameter(register, field, params):
    """A register's field that is a parameter has room for all of its values."""
    most = [p["max"] for p in params if p["name"] == field["name"]]
    if not most or most[0] >> field["bits"]:
        refuse(
            f"registers: {register['name']}: {field['name']}: no parameter, or one that {field['bits']} bits do not hold"
        )
