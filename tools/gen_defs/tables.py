# SPDX-License-Identifier: Apache-2.0
"""Tables of the docs: what stands between <!-- defs:NAME --> and <!-- /defs -->."""

import json
import re
import sys

from expressions import camel, plain
from files import BOARD_FIGURES, FIGURES, TOP

sys.path.append(str(TOP / "tools/fpga_flow"))
import figures as fpga


def filled(defs, text):
    """A page of docs with its tables as the definitions have them."""

    def table(m):
        begin, name, end = m.groups()
        if name not in TABLES:
            raise SystemExit(f"gen-defs: no table {name}")
        return begin + TABLES[name](defs) + end

    return re.sub(r"(<!-- defs:(\w+) -->\n).*?(<!-- /defs -->)", table, text, flags=re.S)


def md(head, rows):
    def line(cells):
        return "| " + " | ".join(str(c).replace("|", "\\|") for c in cells) + " |\n"

    return line(head) + line(["---"] * len(head)) + "".join(line(r) for r in rows)


def params(defs):
    rows = [
        (
            f"`{p['name']}`",
            p["default"],
            "/".join(map(str, p["allowed"])) if "allowed" in p else f"{p['min']} .. {p['max']}",
            "yes" if p in defs.pixel else "no",
            p["doc"],
        )
        for p in defs.pixel + defs.impl
    ]
    return md(("parameter", "default", "range", "affects pixels", "meaning"), rows)


def rules(defs):
    return md(("rule", "holds where"), [(r["doc"], f"`{r['legal']}`") for r in defs.d["rules"]])


def header(defs):
    rows = [(i, f"`{h['name']}`", h["doc"]) for i, h in enumerate(defs.d["header"])]
    return md(("word", "name", "meaning"), rows)


def token_rows(of_tokens):
    def field(f):
        times = f" x {f['repeat']}" if f["repeat"] else ""
        signed = ", signed" if f["signed"] is True else f", signed if {f['signed']}" if f["signed"] else ""
        return f"`{f['name']}`{times} ({plain(f['named_bits'])}{signed})"

    rows = []
    for t in of_tokens:
        needs = "always" if t["needs"] == "1" else t["needs"]
        rows.append((t["code"], f"`{t['name']}`", needs, ", ".join(map(field, t["fields"])) or "-", t["doc"]))
    return md(("kind", "token", "present if", "fields (bits)", "meaning"), rows)


def tokens(defs):
    return token_rows(defs.at_level("spans"))


def polygon_tokens(defs):
    return token_rows(t for t in defs.d["tokens"] if t["level"] == "polygons")


def widths(defs):
    rows = [(f"`{n['name']}`", plain(n["value"]), n["doc"]) for n in defs.field_widths()]
    return md(("width", "bits", "of"), rows)


def order_phases(defs):
    rows = [
        (p["name"], p["doc"], f"without `{p['needs']}`: {p['else']}" if p["needs"] else "")
        for p in defs.d["order_phases"]
    ]
    return md(("phase", "of a frame", "else"), rows)


def order_marks(defs):
    rows = [(f"`{m['name']}`", m["doc"], m["needs"]) for m in defs.d["order_marks"]]
    return md(("mark", "says", "of cores with"), rows)


def order(defs):
    def marks(names):
        return ", ".join(f"`{n}`" for n in names)

    def phases(t):
        names = [p["name"] for p in defs.d["order_phases"]]
        if all(name in t["order"]["in"] for name in names):
            return "everywhere"
        stands = [p["name"] for p in defs.d["order_phases"] if defs.stands_in(t, p)]
        more = [p["name"] for p in defs.d["order_phases"] if defs.stands_in(t, p, "in_passes")]
        return ", ".join(stands) + (f"; with `LINEAR_BITS` {', '.join(more)}" if more else "")

    rows = [
        (
            f"`{t['name']}`",
            phases(t),
            marks(t["order"]["with"]),
            marks(t["order"]["without"]),
            (t["order"]["to"] or "") + (f"; from {', '.join(t['order']['stays'])} not" if t["order"]["stays"] else ""),
            marks(t["order"]["sets"]),
            marks(t["order"]["clears"]),
        )
        for t in defs.at_level("spans")
    ]
    return md(("token", "may stand in", "with", "without", "leads to", "sets", "clears"), rows)


def buses(defs):
    rows = [
        (
            f"`{camel(b['name'])}Bits`, `{b['name']}_t`",
            b["doc"],
            b["from"],
            b["to"],
            ", ".join(f"`{f['name']}` ({defs.told(f['bits'])})" for f in b["fields"]),
        )
        for b in defs.d["buses"]
    ]
    return md(("bus", "is", "from", "to", "fields (bits)"), rows)


def words(defs):
    rows = [
        (
            f"`{camel(w['name'])}Bits`",
            w["doc"],
            ", ".join(f"`{camel(w['name'])}{camel(f['name'])}At` ({plain(f['bits'])})" for f in w["fields"]),
        )
        for w in defs.d["words"]
    ]
    return md(("word", "is", "places (bits)"), rows)


def errors(defs):
    return md(("code", "name", "cause"), [(e["code"], f"`{e['name']}`", e["doc"]) for e in defs.d["errors"]])


def registers(defs):
    rows = [(f"0x{r['addr']:02X}", f"`{r['name']}`", r["access"], defs.register_text(r)) for r in defs.d["registers"]]
    return md(("address", "name", "access", "meaning"), rows)


def board_registers(defs):
    board = defs.d["board"]
    rows = [(f"0x{r['addr']:03X}", f"`{r['name']}`", r["access"], defs.register_text(r)) for r in board["registers"]]
    rows += [
        (f"0x{w['addr']:04X}", f"`{w['name']}`", w["access"], f"{w['words']} words: {defs.register_text(w)}")
        for w in board["windows"]
    ]
    return md(("address", "name", "access", "meaning"), rows)


def figures(_):
    """The figures that tools/fpga --record measured."""

    def clock(r):
        median, all_seeds = f"{r['clock_mhz']:.1f}", r["clocks_mhz"]
        return median if len(all_seeds) == 1 else f"{median} ({min(all_seeds):.1f} .. {max(all_seeds):.1f})"

    def path(r):
        first, *hops, last = r["worst_path"]
        modules = [hop.split(" of ")[1] for hop in hops]
        middle = [m for i, m in enumerate(modules) if m != "kage_wrap" and m not in modules[:i]]
        return f"`{first}`, through {', '.join(middle)}, `{last}`" if middle else f"`{first}`, `{last}`"

    head = (
        "device",
        "core",
        "of RTL",
        "before",
        "clock, MHz",
        "seeds",
        "least loop (bits)",
        "share",
        "LUT",
        "flip-flops",
    )
    rows = [
        (
            r["device"],
            f"`{r['core']}`",
            "earlier" if fpga.moved(TOP, r) else "this",
            f"{r['before_mhz']:.1f}" if "before_mhz" in r else "",
            clock(r),
            len(r["clocks_mhz"]),
            f"{r['least_loop_mhz']:.1f} ({r['loop_bits']})",
            f"{100 * r['clock_mhz'] / r['least_loop_mhz']:.0f} %",
            *(r["cells"].get(cell, "") for cell in ("lut", "ff", "ram", "dsp")),
            path(r),
        )
        for r in json.loads((TOP / FIGURES).read_text())
    ]
    return md((*head, "RAM", "DSP", "worst path"), rows)


def board_figures(_):
    """The figures that tools/fpga BOARD --record measured: first the bitstream's seed, then the worst and the best."""

    def cells(r, kind):
        c = r["cells"].get(kind)
        return f"{c['used']} of {c['available']}" if c else ""

    def clocks(r):
        for c in r["clocks"]:
            text = f"{c['clocks_mhz'][r['best_seed'] - 1]:.1f}"
            if len(c["clocks_mhz"]) > 1:
                text += f" ({min(c['clocks_mhz']):.1f} .. {max(c['clocks_mhz']):.1f})"
            yield f"`{c['clock']}` {text} of {c['need_mhz']:g}"

    def crossing(r):
        """The path between two clocks that comes nearest to what is allowed."""
        ns = lambda c: c["ns"][r["best_seed"] - 1]  # noqa: E731
        c = max(r.get("crossings", []), key=lambda c: ns(c) / c["allowed_ns"], default=None)
        return f"`{c['from']}` to `{c['to']}` {ns(c):.2f} of {c['allowed_ns']:g}" if c else ""

    rows = [
        (
            f"`{r['board']}`",
            "earlier" if fpga.board_moved(TOP, r) else "this",
            *(cells(r, kind) for kind in ("lut", "ff", "ram", "dsp")),
            ", ".join(clocks(r)),
            crossing(r),
            len(r["clocks"][0]["clocks_mhz"]),
        )
        for r in json.loads((TOP / BOARD_FIGURES).read_text())
    ]
    head = ("board", "of RTL", "LUT", "flip-flops", "RAM", "DSP", "clocks, MHz reached of MHz needed")
    return md((*head, "nearest path between clocks, ns of ns allowed", "seeds"), rows)


TABLES = {
    table.__name__: table
    for table in (
        params,
        rules,
        header,
        tokens,
        polygon_tokens,
        widths,
        order_phases,
        order_marks,
        order,
        buses,
        words,
        errors,
        registers,
        board_registers,
        figures,
        board_figures,
    )
}
