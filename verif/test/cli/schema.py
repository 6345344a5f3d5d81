# SPDX-License-Identifier: Apache-2.0
"""JSON against the schemas that it names: schema.py SCHEMAS FOLDER [KAGE], with FOLDER/COMMAND.N.json. With KAGE it is the
JSON of all commands, and each schema must be one of theirs."""

import copy
import json
import pathlib
import re
import subprocess
import sys

import jsonschema

folder, written, kage = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:]
failures = 0


def check(good, what):
    global failures
    if not good:
        failures += 1
        print("FAILED:", what)


schemas = {path.stem: json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))}


def validator(name):
    """Schemas refer to each other by the names of their files."""
    schema = schemas[name]
    try:
        from referencing import Registry
        from referencing.jsonschema import DRAFT202012
    except ImportError:  # jsonschema 4.10 of Debian 12
        store = {f"{n}.json": s for n, s in schemas.items()}
        resolver = jsonschema.RefResolver(f"{name}.json", schema, store=store)
        return jsonschema.Draft202012Validator(schema, resolver=resolver)
    registry = Registry().with_resources((f"{n}.json", DRAFT202012.create_resource(s)) for n, s in schemas.items())
    return jsonschema.Draft202012Validator(schema, registry=registry)


def closed(name, schema, place=""):
    """Each object says which keys it may have, and each key what it is."""
    if isinstance(schema, list):
        for i, part in enumerate(schema):
            closed(name, part, f"{place}/{i}")
    if not isinstance(schema, dict):
        return
    if "properties" in schema:
        check(schema.get("additionalProperties") is False, f"{name}{place}: takes any key")
        for key, value in schema["properties"].items():
            parts = [value, *value.get("anyOf", [])]
            told = any(word in part for part in parts for word in ("description", "$ref", "const"))
            check(told, f"{name}{place}: {key}: what is it?")
    for key, value in schema.items():
        closed(name, value, f"{place}/{key}")


for name, schema in schemas.items():
    jsonschema.Draft202012Validator.check_schema(schema)
    closed(name, schema)
    check(f"({name}.json)" in (folder / "README.md").read_text(), f"{name}: docs/schema/README.md does not name it")

validators = {name: validator(name) for name in schemas}
named, wrote = set(), set()


def good(name, document):
    return validators[name].is_valid(document)


# Keys that are not always there, some in one place only, and objects whose keys are names. Names are those of
# parameters (a plan's reasons are by parameter, too), phases, kinds of tokens, configurations, terms of an estimate, or
# of a model's manifest, which is shown as it is.
SOMETIMES = {"own_sizes", "ahead", "takes", "in_place", "coverage", "scenes", "configs", "faults", "left", "bytes"}
SOMETIMES_IN = {
    ("", "clocks"),
    ("models/*", "damage"),
    ("clocks/*", "worst_path"),
    ("verdicts", "removed"),
    ("touches/*", "units"),
    ("touches/*", "tree"),
    ("first_difference", "scene"),
    ("", "board"),
    ("", "need"),
    ("frames/*", "error_frame"),
    ("frames/*", "error_line"),
    ("frames/*", "error_token"),
    ("frames/*", "error_unit"),
    ("cells", "ram"),
    ("cells", "dsp"),
    ("*/runs/*", "named"),
    ("*/runs/*", "right"),
}
NAMES = {"config", "stalled_by_phase", "about", "tokens", "lacks", "parameters", "board_parameters", "tools", "seconds"}
NAMES |= {"reasons", "terms"}
tried = set()


def objects(document, place=()):
    """All objects within, by the keys and indices that lead there."""
    if isinstance(document, dict):
        yield place, document
    for key, value in (
        document.items() if isinstance(document, dict) else enumerate(document) if isinstance(document, list) else ()
    ):
        yield from objects(value, (*place, key))


def spoilt(name, document, where):
    """Without one of its keys, or with another one, at any depth, it is not of its schema: else the schema would hold
    anything. A trial in the same place of the same schema is not repeated."""
    for place, entry in objects(document):
        if NAMES & set(place):
            continue
        path = tuple("*" if isinstance(step, int) else step for step in place)
        for key in [*entry, None]:
            if (name, path, key) in tried or key in SOMETIMES or ("/".join(path), key) in SOMETIMES_IN:
                continue
            tried.add((name, path, key))
            other = copy.deepcopy(document)
            at = other
            for step in place:
                at = at[step]
            if key is None:
                at["nosuch"] = 1
            else:
                del at[key]
            check(
                not good(name, other),
                f"{where}: {name} takes it {'with a strange key' if key is None else f'without {key}'} in /{'/'.join(path)}",
            )


for path in sorted(written.iterdir()):
    document = json.loads(path.read_text())
    entries = document if isinstance(document, list) else [document]
    if not entries or not all(isinstance(e, dict) and next(iter(e), None) == "schema" for e in entries):
        check(False, f"{path.name}: the schema is not its first key")
        continue
    match = re.fullmatch(r"kage\.([a-z-]+)/\d+", entries[0]["schema"])
    if not match or match[1] not in schemas:
        check(False, f"{path.name}: no schema {entries[0]['schema']}")
        continue
    name = match[1]
    named.add(name)
    wrote.add(path.name.split(".")[0])
    for error in validators[name].iter_errors(document):
        best = jsonschema.exceptions.best_match([error])
        check(False, f"{path.name}: {name}: {'/'.join(map(str, best.absolute_path))}: {best.message[:300]}")
    spoilt(name, document, path.name)


def all_commands(kage):
    """Each schema is named here, but for those of tools that are tried elsewhere, and each command that has JSON writes some."""
    # By tools/test-fpga and the tests tools/stub-cores and extremes/program.
    elsewhere = {"fpga", "fpga-board", "fpga-core", "stub-cores", "extremes"}
    check(named == set(schemas) - elsewhere, f"schemas that no command names: {set(schemas) - named - elsewhere}")
    text = subprocess.run([kage, "--help"], capture_output=True, text=True, check=True).stdout
    commands = re.findall(r"^  ([a-z]+) ", text.split("Subcommands:")[1].split("\n\n")[0], re.M)
    check(len(commands) >= 12, f"these are all commands: {commands}")
    for command in commands:
        text = subprocess.run([kage, "help", command], capture_output=True, text=True, check=True).stdout
        check(("--json" in text) == (command in wrote), f"kage {command}: --json is not tried here")
    check(any(len(path) > 3 for _, path, _ in tried), "nothing deep is spoilt")


check(bool(wrote), f"{written}: no JSON")
if kage:
    all_commands(kage[0])
sys.exit(failures != 0)
