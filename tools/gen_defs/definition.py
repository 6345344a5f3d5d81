# SPDX-License-Identifier: Apache-2.0
"""rtl/defs/kage.yaml, read, checked and completed: what all that is generated of it has in common."""

import itertools
import re
import types

import checks
import curve
import yaml
from expressions import camel, cpp_expr, plain, py_expr
from files import SOURCE


class Defs:
    """The definition: `d` as the file has it, completed, and what templates and generators ask of it."""

    def __init__(self, path):
        self.d = yaml.safe_load(path.read_text())
        self.pixel = self.d["pixel_params"]
        self.impl = self.d["impl_params"]
        self.names = {p["name"] for p in self.pixel + self.impl}
        # One definition of what is the same in every configuration and of what is not: <name> stands for either.
        constants = {c["name"]: c["value"] for c in self.d["constants"]}
        self.d |= constants
        self.constants = constants
        for word in self.d["words"]:
            bits = " + ".join(str(f["bits"]) for f in word["fields"])
            self.d["derived"].append({"name": f"{word['name']}_bits", "value": bits, "doc": word["doc"]})
            for field in word["fields"]:
                field.setdefault("lacks", False)
                field["member"] = "normal_class" if field["name"] == "class" else field["name"]  # as C++ calls it
        self.derived = {n["name"]: n for n in self.d["derived"]}
        self.derived |= {c["name"]: {**c, "value": str(c["value"])} for c in self.d["constants"]}
        for number in self.d["derived"]:
            number.setdefault("is", "")
        # A token's `code` is what its words begin with. Its kind is a number that no other has: those of the polygon level
        # come behind all that a word can hold.
        for token in self.d["tokens"]:
            token.setdefault("level", "")
            token["code"] = token["kind"]
            token["sv_needs"] = token["needs"]  # of modules that know pixel parameters alone: those of a front end ask
            if token["level"] == "polygons":
                token["needs"] = "ACTIVE > 0" + ("" if token["needs"] == "1" else f" && {token['needs']}")
                token["kind"] += 2 ** constants["kind_bits"]
                token["order"] = {"in": []}
            for field in token["fields"]:
                # A constant is a number; a width that a configuration decides keeps its name.
                constant = constants.get(str(field["bits"]).strip("<>")) if str(field["bits"]).startswith("<") else None
                field["named_bits"] = field["bits"] if constant is None else constant
                field["bits"] = self.expanded(field["bits"])
                field["cpp"] = self.cpp_member(token, field)
                for absent in ("repeat", "left_out", "signed"):
                    field.setdefault(absent, False)
            for absent in ("span", "touches", "clocks", "text"):
                token.setdefault(absent, "")
            for absent in ("in_passes", "stays", "with", "without", "sets", "clears", "to"):
                token["order"].setdefault(absent, [])
        for phase in self.d["order_phases"]:
            for absent in ("also", "needs", "line"):
                phase.setdefault(absent, "")
        for mark in self.d["order_marks"]:
            mark.setdefault("line", "")
        self.d["kinds"] = max(t["kind"] for t in self.d["tokens"]) + 1
        of_kind = {t["kind"]: t for t in self.d["tokens"]}
        self.d["by_kind"] = [of_kind.get(kind) for kind in range(self.d["kinds"])]  # None: no kind
        self.d |= {"curve": curve.thresholds(), "curve_frac": curve.FRAC}
        self.header_fields = []
        for at, word in enumerate(self.d["header"]):
            word["doc"] = word["doc"].format(**self.d["hash"], **constants)
            for field in word["fields"]:
                field["doc"] = field["doc"].format(**self.d)
            lsb = 0
            for field in word["fields"]:
                self.header_fields.append({**field, "word": at, "lsb": lsb})
                lsb += field["bits"]
            assert lsb == 32, f"header word {word['name']} has {lsb} bits"
        for error in self.d["errors"]:
            error.setdefault("of_unit", False)
        unit_errors = [e["name"] for e in self.d["errors"] if e["of_unit"]]
        for register in self.d["registers"]:
            register["doc"] = register["doc"].format(
                unit_errors=f"{', '.join(unit_errors[:-1])} or {unit_errors[-1]}", **constants
            )
            for field in register.get("fields", []):
                if isinstance(field["bits"], str):
                    field["bits"] = constants[field["bits"].strip("<>")]
                if field.setdefault("parameter", False):
                    checks.holds_parameter(register, field, self.pixel + self.impl)
                    field["doc"] = "the parameter"
        checks.constants_hold(self.d, self.pixel + self.impl)
        checks.same_entry(self.d)
        # Places that tokens with a range share: the name, a token that has it there, and how that one calls it.
        self.shared_places = [
            (shared, checks.same_place(self.d, name, "xr"), name)
            for shared, name in (("range_xl", "xl"), ("range_xr", "xr"), ("weight", "w"))
        ]

    @staticmethod
    def numbered(entries):
        """Fields by the numbers of the C interface, `times` of them each, and how many there are."""
        fields, count = [], 0
        for f in entries:
            fields.append({"times": 1, "of": "1"} | f | {"number": count})
            count += fields[-1]["times"]
        return fields, count

    def golden_numbers(self):
        """Fields of tokens by the numbers of the C interface, and how many there are. All that tokens have must be there."""
        fields, count = self.numbered(self.d["golden_fields"])
        known = {f["name"] for f in fields} | {"pad"}
        for t in self.d["tokens"]:
            for f in t["fields"]:
                if f["name"] not in known:
                    raise SystemExit(f"{SOURCE}: golden_fields: lacks {f['name']} of {t['name']}")
        return fields, count

    def golden_pixel(self):
        """Fields of a pixel's state likewise; `has`: where a configuration has the field, in which the word has bits for it."""
        fields, count = self.numbered(self.d["golden_pixel"])
        checks.same_pixel(self.d, fields, {p["name"]: p["max"] for p in self.pixel + self.impl})
        word = next(word for word in self.d["words"] if word["name"] == "pixel")
        for f, of_word in zip(fields, word["fields"]):
            f["has"] = f"({self.expanded(of_word['bits'])}) > 0" if of_word["lacks"] else ""
        return fields, count

    @staticmethod
    def cpp_member(token, field):
        """Where C++ keeps the field in a Token; None for what it keeps nowhere."""
        if field.get("member", "") is None:
            return None
        owner = field.get("of", token.get("of"))
        return (f"{owner}." if owner else "") + field.get("member", field["name"])

    def at_level(self, level):
        """Tokens of frames at a level, `spans` or `polygons`."""
        return [t for t in self.d["tokens"] if t["level"] in ("", level)]

    @staticmethod
    def stands_in(token, phase, key="in"):
        """Whether the token may stand in that phase, marks permitting; or another list of phases of its order has it."""
        return phase["name"] in token["order"][key] or phase["also"] in token["order"][key]

    def order_bits(self, token, key="in"):
        """The phases of such a list as binary digits, the first phase last."""
        return "".join("01"[self.stands_in(token, p, key)] for p in reversed(self.d["order_phases"]))

    def sv_order(self, what):
        """[(value, [KindX, ...]), ...]: for which kinds line_phase's function of this name has which value but its default."""
        phases = [p for p in self.d["order_phases"] if p["line"]]
        marks = {m["name"] for m in self.d["order_marks"] if m["line"]}

        def value(t):
            order, names = t["order"], [p["name"] for p in phases]
            # A token that leaves the line's phases ends the line, and line_phase begins anew.
            stays = not order["to"] or order["to"] in names
            if what == "kind_is_state":
                return "1'b1" if order["in"] == ["state"] else None
            if what == "kind_has_range":
                return needs(t) if any(f["name"] == "xr" for f in t["fields"]) else None
            of_line = [n for n in names if n in order["in"]] if "behind" not in order["in"] else []
            if not of_line:
                return None
            if what == "order_in":

                def digits(of):
                    return f"{len(phases)}'b" + "".join("01"[n in of] for n in reversed(names))

                more = digits(of_line + order["in_passes"])
                return digits(of_line) if more == digits(of_line) else f"LINEAR_BITS > 0 ? {more} : {digits(of_line)}"
            if what == "order_to":
                if not stays or not order["to"] or of_line == [order["to"]]:
                    return None
                to = "Phase" + camel(order["to"])
                return to if t["needs"] == "1" else f"{t['needs']} ? {to} : phase"
            key = what.removeprefix("order_")
            if key in ("sets", "clears") and not stays:
                return None
            return " | ".join("Mark" + camel(m) for m in order[key] if m in marks) or None

        def needs(t):
            return "1'b1" if t["needs"] == "1" else t["needs"]

        groups = {}
        for t in self.at_level("spans"):
            if value(t):
                groups.setdefault(value(t), []).append("Kind" + camel(t["name"]))
        return list(groups.items())

    def field_widths(self):
        """The derived numbers that fields of tokens have for their bits, and those that these are made of."""
        bits = " ".join(str(f["named_bits"]) for t in self.d["tokens"] for f in t["fields"])
        found = []
        for n in reversed(self.d["derived"]):  # what a number is made of stands before it
            if f"<{n['name']}>" in bits:
                found.insert(0, n)
                bits += n["value"]
        return found

    def most_bits(self, field):
        """Bits of a token's field, its channels together, in no configuration more: the most over all values of the
        parameters that it follows from."""

        def most(expr):
            params = [p for p in self.pixel + self.impl if re.search(rf"\b{p['name']}\b", str(expr))]
            values = (p.get("allowed", range(p["min"], p["max"] + 1)) for p in params)
            code = compile(py_expr(expr), SOURCE, "eval")
            names = [p["name"] for p in params]
            return max(
                eval(code, {"c": types.SimpleNamespace(**dict(zip(names, chosen)))})
                for chosen in itertools.product(*values)
            )

        return most(field["bits"]) * (most(field["repeat"]) if field["repeat"] else 1)

    def most_token_words(self):
        """Words of the longest token of any configuration, or more."""
        bits = (self.d["kind_bits"] + sum(map(self.most_bits, t["fields"])) for t in self.d["tokens"])
        return (max(bits) + 31) // 32

    def most_field_bits(self):
        """Bits of the widest field of a token, one channel, in any configuration."""
        return max(self.most_bits(f | {"repeat": False}) for t in self.d["tokens"] for f in t["fields"])

    @staticmethod
    def text_pieces(token):
        """The pieces of a token's text, in order: {form, names, cpp}. Form `text` is plain text; other forms are those of `text`."""
        pieces, plain = [], token["name"]
        # These forms bring their space themselves, where they say something.
        plain += " " if token["text"] and not re.match(r"\{\w+:(class|face|flag|samples)\}", token["text"]) else ""
        members = {f["name"]: "t." + str(f["cpp"]) for f in token["fields"]}

        def flush():
            if plain:
                pieces.append({"form": "text", "names": [], "literal": plain, "cpp": f'"{plain}"'})

        for literal, names, form in re.findall(r"([^{}]*)(?:\{([\w,]+)(?::(\w+))?\})?", token["text"]):
            plain += literal
            if not names:
                continue
            flush()
            plain, names = "", names.split(",")
            arguments = [f'"{names[0]}"'] * (form == "flag") + [members[name] for name in names]
            pieces.append({"form": form or "plain", "names": names, "literal": "", "cpp": ", ".join(arguments)})
        flush()
        return pieces

    def expanded(self, expr):
        """An expression with its <name>s replaced by what they stand for; alone, a name needs no parentheses."""
        alone = re.fullmatch(r"<(\w+)>", str(expr))
        if alone:
            return self.expanded(self.derived[alone.group(1)]["value"])
        return re.sub(r"<(\w+)>", lambda m: f"({self.expanded(self.derived[m.group(1)]['value'])})", str(expr))

    def cpp_derived(self, expr):
        """An expression as C++ with derived.hpp has it."""

        def name(m):
            return f"k{camel(m.group(1))}" if m.group(1) in self.constants else f"derived::{m.group(1)}(c)"

        return re.sub(r"<(\w+)>", name, cpp_expr(expr, self.names))

    def told(self, expr):
        """An expression for a reader: what is the same in every configuration by its value, the rest by its name."""
        return plain(re.sub(r"<(\w+)>", lambda m: str(self.constants.get(m.group(1), m.group(0))), str(expr)))

    def sv_name(self, name):
        """How SystemVerilog calls a derived number."""
        return self.derived[name].get("sv", camel(name))

    def sv_expr(self, expr):
        """An expression as SystemVerilog has it: <name>s become the localparams of kage_widths.svh."""
        return re.sub(r"<(\w+)>", lambda m: self.sv_name(m.group(1)), str(expr))

    def sv_bits(self, field):
        """The width of a bus's field."""
        return self.sv_expr(field["bits"])

    @staticmethod
    def register_text(r):
        """The meaning of a register, with its fields: a table's cell, or a comment."""
        text = f"0x{r['value']:08X}, {r['doc']}" if "value" in r else r["doc"]
        fields = []
        for f in r.get("fields", []):
            last = f["lsb"] + f["bits"] - 1
            place = f"bit {last}" if f["bits"] == 1 else f"bits {last}-{f['lsb']}"
            fields.append(f"{place} {f['name']}" + ("" if f.get("parameter") else f": {f['doc']}"))
        return text + (": " if fields else "") + "; ".join(fields)
