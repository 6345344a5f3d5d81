#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hls/tool alone: what it refuses, by name; graphs that stay what they are when they are made small, cut and put in stages.

usage: tool.py SOURCE_DIR [SEED]
"""

import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

top = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(top / "hls"))

from tool import __main__ as flow  # noqa: E402
from tool import graph, llvm_ir, rewrite, schedule  # noqa: E402
from tool.delays import Delays  # noqa: E402
from tool.trouble import Trouble  # noqa: E402

HEAD = '#include "types.hpp"\nstruct In { hw::u<8> a, b; };\nstruct Out { hw::u<8> r; };\n'
KERNEL = 'extern "C" void k(const In& __restrict in, Out& __restrict out) '
REFUSED = {
    "a loop is left": KERNEL
    + "{ hw::u<8> s(0); for (hw::u<8> i(0); i < in.a; i = i + hw::u<8>(1)) s = s ^ (s * in.b + i); out.r = s; }",
    "a call of": "hw::u<8> other(hw::u<8>);\n" + KERNEL + "{ out.r = other(in.a); }",
    "memory that is no port": "hw::u<8> table[256];\n" + KERNEL + "{ out.r = table[(int)in.a]; }",
    "instruction udiv": KERNEL + "{ out.r = in.a / in.b; }",
    "under a condition alone": KERNEL + "{ if (in.a < in.b) out.r = in.a; }",
    "lacks __restrict": 'extern "C" void k(const In& in, Out& out) { out.r = in.a; }',
    "it is no void f": 'extern "C" void k(In& __restrict in, Out& __restrict out) { in.a = in.b; out.r = in.a; }',
    "no such function": 'extern "C" void other(const In& __restrict in, Out& __restrict out) { out.r = in.a; }',
}


def fail(text):
    print(f"tool.py: {text}", file=sys.stderr)
    sys.exit(1)


def refusal(source):
    """The tool's message about a kernel that it cannot make hardware of; empty if it takes it."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "kernel.cpp"
        path.write_text(HEAD + source + "\n")
        command = [flow.clang(), *flow.FLAGS, f"-I{top}/hls", str(path), "-o", "-"]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    try:
        llvm_ir.Reader(done.stdout, "k").read()
    except Trouble as e:
        return str(e)
    return ""


def random_graph(dice):
    """Any operations on any widths."""
    g = graph.Graph()
    nodes = [g.input(f"i{k}", dice.choice((1, 3, 8, 17, 25, 40))) for k in range(4)]

    def of(width):
        """A value of a width: a node, cut or extended, or a constant."""
        if dice.random() < 0.15:
            return g.const(width, dice.choice((0, 1, -1, 1 << (width - 1), dice.getrandbits(width))))
        n = dice.choice(nodes)
        if n.width > width:
            return g.slice(n, dice.randrange(n.width - width + 1), width)
        return (g.sext if dice.random() < 0.5 else g.zext)(n, width)

    for _ in range(30):
        width = dice.choice((1, 2, 5, 8, 16, 26, 40, 51))
        a, b = of(width), of(width)
        match dice.randrange(11):
            case 0 | 1:
                n = g.add(a, b)
            case 2 | 3:
                n = g.sub(a, b)
            case 4:
                n = g.mul(a, b)
            case 5:
                n = g.and_(a, b)
            case 6:
                n = g.or_(a, b)
            case 7:
                n = g.xor(a, b)
            case 8:
                n = g.mux(of(1), a, b)
            case 9:
                n = g.less(a, b, dice.random() < 0.5) if dice.random() < 0.5 else g.equal(a, b)
            case _:
                by = dice.randrange(width + 2)
                n = g.shift_left(a, by) if dice.random() < 0.5 else g.shift_right(a, by, dice.random() < 0.5)
        nodes.append(n)
    for k, n in enumerate(nodes[-4:]):
        g.outputs[f"o{k}"] = g.slice(n, 0, dice.randrange(n.width) + 1)
    return g


def check_known(g, inputs):
    """The facts known about each node hold for these inputs."""
    for n in graph.live(g.outputs.values()):
        whole = graph.Graph.__new__(graph.Graph)
        whole.outputs = {"n": n}
        value = graph.evaluate(whole, inputs)["n"]
        if value & n.zeros or n.ones & ~value:
            fail(f"{n} is {value:x}, known zeros {n.zeros:x}, ones {n.ones:x}")
        top_bits = value >> (n.width - n.signs)
        if top_bits not in (0, graph.mask(n.signs)):
            fail(f"{n} is {value:x}, said to have {n.signs} equal upper bits")


def check_stages(g, plan, delays):
    """Operands are there when they are needed, and no stage takes longer than the period."""
    ready = {}
    for n in graph.live(g.outputs.values()):
        if n.op == "const":
            continue
        stage = plan.stage_of[n.number]
        begin = delays.register
        for a in n.args:
            if a.op == "const":
                continue
            if plan.stage_of[a.number] > stage:
                fail(f"{n} in stage {stage} needs {a} of stage {plan.stage_of[a.number]}")
            if plan.stage_of[a.number] == stage:
                begin = max(begin, ready[a.number])
        ready[n.number] = begin + (0 if n.op in graph.WIRING else delays.of(n))
        if stage >= plan.stages or ready[n.number] > plan.period + 1e-9:
            fail(f"{n} in stage {stage} of {plan.stages} ends at {ready[n.number]} of {plan.period} ns")


def main():
    if shutil.which("clang-14") or shutil.which("clang++-14"):
        for words, source in REFUSED.items():
            said = refusal(source)
            if words not in said:
                fail(f"'{source}' is refused for '{said}', not for '{words}'")
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else random.SystemRandom().randrange(1 << 32)
    dice = random.Random(seed)
    delays = Delays.read(top / "hls/tool/delays/ecp5-85f.json")
    for _ in range(150):
        g = random_graph(dice)
        small = rewrite.narrowed(rewrite.tiled(rewrite.narrowed(g), 18))
        for _ in range(12):
            inputs = {
                name: dice.choice((0, -1, dice.getrandbits(64))) & graph.mask(n.width) for name, n in g.inputs.items()
            }
            if graph.evaluate(g, inputs) != graph.evaluate(small, inputs):
                fail(f"seed {seed}: {graph.evaluate(g, inputs)} became {graph.evaluate(small, inputs)} for {inputs}")
            check_known(g, inputs)
        check_stages(small, schedule.scheduled(small, delays, dice.randrange(1, 9)), delays)
    print("150 graphs: the same")


main()
