# SPDX-License-Identifier: Apache-2.0
"""nextpnr's timing report in the RTL's words: modules and registers in place of cells."""

import re

# End of the name of a cell that yosys made of a signal, behind the signal's name.
CELL = re.compile(
    r"_(TRELLIS_FF|SB_DFF\w*?|LUT4|SB_LUT4|CCU2C|SB_CARRY|PFUMX|L6MUX21|TRELLIS_DPR16X4|DP16KD|SB_RAM40_4K)(_|$).*|_\$.*|\$.*"
)


class Places:
    """Finds the module that a cell of the flat netlist lies in, and the signal that it belongs to."""

    def __init__(self, modules, top, netlist):
        self.cells = netlist["cells"]
        self.module_of = {"": self.plain(top)}
        self.walk(modules, top, "")

    @staticmethod
    def plain(name):
        """$paramod$hash\\line_out and $paramod\\line_out\\X=1 are line_out."""
        if name.startswith("$paramod"):
            return next(part for part in name.split("\\")[1:] if part)
        return name

    def walk(self, modules, name, path):
        for cell, what in modules.get(name, {"cells": {}})["cells"].items():
            if what["type"] in modules:
                at = f"{path}{cell}."
                self.module_of[at] = self.plain(what["type"])
                self.walk(modules, what["type"], at)

    def module(self, cell):
        path = cell
        while path:
            path = path[: path.rfind(".", 0, len(path) - 1) + 1]
            if path in self.module_of:
                return self.module_of[path]
        return self.module_of[""]

    def signal(self, cell):
        """The signal's name within its module."""
        at = cell
        for path in sorted(self.module_of, key=len, reverse=True):
            if path and cell.startswith(path):
                at = cell[len(path) :]
                break
        return CELL.sub("", at) or at

    def register(self, cell):
        """Module and signal of a flip-flop or a RAM. The source line of a flip-flop's process beats its name, which may be
        that of a net in another module."""
        m = re.match(
            r"(?:rtl|rtl/board|constraints/boards/\w+)/(\w+)\.sv:",
            self.cells.get(cell, {}).get("attributes", {}).get("src", ""),
        )
        return f"{m.group(1) if m else self.module(cell)} {self.signal(cell)}"


def worst_path(report, places, clock=None):
    """{from, to, ns, logic_ns, route_ns, cells, modules} of the worst path from register to register: of rising edges, or of
    all edges of one clock, which is named as nextpnr names its net."""

    def counts(p):
        edges = [p["from"].split(" "), p["to"].split(" ")]
        return all(e[1:] == [clock] if clock else e[0] == "posedge" for e in edges)

    path = max(
        (p for p in report["critical_paths"] if counts(p)),
        key=lambda p: sum(s["delay"] for s in p["path"]),
    )["path"]
    logic = sum(s["delay"] for s in path if s["type"] != "routing")
    route = sum(s["delay"] for s in path if s["type"] == "routing")
    hops = [s["to"]["cell"] for s in path if s["type"] == "logic"]
    through = []  # [module, cells] in order
    for cell in hops:
        module = places.module(cell)
        if through and through[-1][0] == module:
            through[-1][1] += 1
        else:
            through.append([module, 1])
    return {
        "from": places.register(path[0]["from"]["cell"]),
        "to": places.register(path[-1]["to"]["cell"]),
        "ns": logic + route,
        "logic_ns": logic,
        "route_ns": route,
        "cells": len(hops),
        "through": through,
    }


def tell(p, title="worst path"):
    """A path for people."""
    print(f"{title} {p['ns']:.2f} ns, logic {p['logic_ns']:.2f}, route {p['route_ns']:.2f}: {p['from']}")
    for module, cells in p["through"]:
        print(f"    through {cells} cell{'s' if cells > 1 else ''} of {module}")
    print(f"    to {p['to']}")


def worst_endpoints(report, places, count):
    """The registers with the latest arrivals, a row each: what comes next once the worst path is gone. Names without bits."""
    worst = {}
    for net in report["detailed_net_timings"]:
        if not net["event"].startswith("posedge"):
            continue
        for end in net["endpoints"]:
            if not end["event"].startswith("posedge"):
                continue
            key = places.register(end["cell"])
            ns = max(end["delay"])
            if ns > worst.get(key, (0, ""))[0]:
                worst[key] = (ns, end["port"])
    rows = sorted(worst.items(), key=lambda item: (-item[1][0], item[0]))[:count]
    return [{"register": key, "ns": ns, "port": port} for key, (ns, port) in rows]
