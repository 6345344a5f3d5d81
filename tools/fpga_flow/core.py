# SPDX-License-Identifier: Apache-2.0
"""Which core is meant: device, configuration and parameters from the command line and the YAML files."""

import dataclasses
import functools
import pathlib

import yaml
from trouble import Trouble


@dataclasses.dataclass(frozen=True)
class Device:
    name: str
    family: str  # ecp5 or ice40
    nextpnr: tuple  # its options for the device
    synth: tuple = ()  # yosys' options of synth_FAMILY for a core that is placed without a board


@dataclasses.dataclass(frozen=True)
class Core:
    name: str
    values: dict  # parameters that are set; the others have their defaults
    parameters: dict  # all of them

    @property
    def loop_bits(self):
        """Width of the least loop: a depth with its fraction."""
        return self.parameters["Z_BITS"] + self.parameters["Z_FRAC"]


@functools.cache
def read_yaml(path):
    """The contents of a file, which nobody may change: who asks again gets the same."""
    try:
        return yaml.safe_load(path.read_text()) or {}
    except OSError as e:
        raise Trouble(f"{path}: {e.strerror}") from e
    except yaml.YAMLError as e:
        raise Trouble(f"{path}: not YAML: {str(e).splitlines()[0]}") from e


def find_device(top, name):
    devices = read_yaml(top / "constraints/devices.yaml")
    if name not in devices:
        boards = read_yaml(top / "constraints/boards/boards.yaml")
        raise Trouble(f"{name}: no such device or board; there are {', '.join([*devices, *boards])}")
    d = devices[name]
    return Device(name, d["family"], tuple(d["nextpnr"]), tuple(map(str, d.get("synth", ()))))


def find_core(top, words):
    """`words`: at most one CONFIG, and any PARAM=VALUE."""
    names = [w for w in words if "=" not in w]
    if len(names) > 1:
        raise Trouble(f"{names[1]}: one configuration is enough, and {names[0]} is one")
    name, values = (names or ["default"])[0], {}
    cores = read_yaml(top / "rtl/defs/configs.yaml") | read_yaml(top / "constraints/cores.yaml")
    if name in cores:
        values = dict(cores[name] or {})
    elif pathlib.Path(name).is_file():
        values = read_yaml(pathlib.Path(name))
        if not isinstance(values, dict):
            raise Trouble(f"{name}: not PARAMETER: value lines")
        values = dict(values)
        name = pathlib.Path(name).stem
    else:
        raise Trouble(f"{name}: neither a configuration ({', '.join(cores)}) nor a file")
    for word in words:
        if "=" in word:
            key, value = word.split("=", 1)
            if not value.isdecimal():
                raise Trouble(f"{word}: {key} takes a whole number")
            values[key] = int(value)
            name += f"-{key}{value}"
    return checked(top, name, values)


def definition(top):
    return read_yaml(top / "rtl/defs/kage.yaml")


def checked(top, name, values):
    """The core with these parameters, if they are legal."""
    known = {p["name"]: p for p in definition(top)["pixel_params"] + definition(top)["impl_params"]}
    for key, value in values.items():
        if key not in known:
            raise Trouble(f"{name}: {key}: no such parameter (docs/stream.md#parameters)")
        p = known[key]
        if (
            not isinstance(value, int)
            or isinstance(value, bool)
            or not p["min"] <= value <= p["max"]
            or value not in p.get("allowed", [value])
        ):
            legal = "/".join(map(str, p["allowed"])) if "allowed" in p else f"{p['min']} .. {p['max']}"
            raise Trouble(f"{name}: {key} is {value}; legal is {legal}")
    return Core(name, values, {k: values.get(k, p["default"]) for k, p in known.items()})
