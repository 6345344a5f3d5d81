# SPDX-License-Identifier: Apache-2.0
"""Mutants: put into a copy of the RTL, each behind a select."""

import defects
import sources
from steps import fail

KEYS = ("class", "configs", "port")  # that the list has beside those of each list of defects


def put_in(rtl, package):
    """Put every mutant into the copy `rtl`, a folder of that name, behind a select, which `package` holds; return how many there are."""
    try:
        mutants = defects.load(sources.only("mutants"), KEYS)
    except defects.DefectError as e:
        fail(str(e))
    places = {}
    for number, m in enumerate(mutants.values(), 1):
        if "changes" in m:
            fail(f"mutant {m['name']}: it changes one place, and has no `changes`")
        try:
            begin = defects.place((rtl.parent / m["file"]).read_text(), m)
        except defects.DefectError as e:
            fail(f"mutant {m['name']}: {e}")
        # A mutant that is put in before an instance's `.*` leaves room for another there.
        places.setdefault(m["file"], []).append((begin, begin if "port" in m else begin + len(m["was"]), number, m))
    for name, of_file in places.items():
        text = (rtl.parent / name).read_text()
        of_file.sort(key=lambda p: p[0])
        for before, after in zip(of_file, of_file[1:]):
            if before[1] > after[0] and before[:2] != after[:2]:
                fail(f"mutant {after[3]['name']}: overlaps {before[3]['name']}")
        # Mutants of one text form a chain of choices, with the sound RTL's text as its end.
        together = {}
        for begin, end, number, m in of_file:
            together.setdefault((begin, end, m.get("port")), []).append((number, m["is"]))
        for (begin, end, port), choices in reversed(together.items()):
            choice = port or text[begin:end]
            for number, mutated in choices:
                choice = f"(kage_mutants::selected == {number} ? {mutated} : {choice})"
            text = f"{text[:begin]}.{port}{choice}, {text[end:]}" if port else text[:begin] + choice + text[end:]
        (rtl.parent / name).write_text(text)
    # Sampled in reset: asked for at each place, it would cost more than the model.
    top = (rtl / "kage_top.sv").read_text()
    sample = '  import "DPI-C" function int kage_mutant();\n  always_ff @(posedge clk_i) if (!rst_ni) kage_mutants::selected <= kage_mutant();\n'
    head, end, tail = top.rpartition("endmodule")
    (rtl / "kage_top.sv").write_text(head + sample + end + tail)
    package.write_text("package kage_mutants;\n  int selected;\nendpackage\n")
    return len(mutants)
