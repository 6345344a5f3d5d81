# SPDX-License-Identifier: Apache-2.0
"""A monitor of a module's ports, which writes them at every clock: what `kage vectors --module` records."""

import re

from steps import fail

NAME = "kage_ports.sv"


def ports_of(rtl, module):
    """(direction, name) of each port of rtl/MODULE.sv but the clock, in their order."""
    path = rtl / f"{module}.sv"
    if not path.exists():
        fail(f"{module}: no {path}")
    text = re.sub(r"//[^\n]*", "", path.read_text())
    header = re.search(r"^module .*?\) \((.*?)\n\);", text, re.M | re.S)
    if not header:
        fail(f"{path}: its ports are not found")
    ports = header[1]
    for name in re.findall(r'`include "([\w.]+)"', ports):
        ports += re.sub(r"//[^\n]*", "", (rtl / "include" / name).read_text())
    found = re.findall(r"\b(input|output)\s+(?:wire\s+)?logic\s*(?:\[[^\]]*\])?\s*(\w+)", ports)
    return [(direction, name) for direction, name in found if name != "clk_i"]


def parameters_of(rtl, module, known):
    """The parameters that the module declares: those of the core by their headers, and its own."""
    text = (rtl / f"{module}.sv").read_text()
    header = re.search(r"^module .*?#\((.*?)\n\) \(", text, re.M | re.S)[1]
    names = re.findall(r"^\s*parameter\s+(?:int\s+)?(\w+)", header, re.M)
    if "kage_pixel_params.svh" in header:
        names = [n for n in known if n not in names] + names
    return names


def write_monitor(path, rtl, module, known):
    """`known`: parameters that change pixels. From the first clock without reset on, lines of text: "kage_ports INSTANCE in|out|parameter NAME NUMBER", then for
    each clock "kage_ports INSTANCE clock INPUTS OUTPUTS", in hexadecimal, the first port in the uppermost bits."""
    ports = ports_of(rtl, module)
    inputs = [n for d, n in ports if d == "input"]
    outputs = [n for d, n in ports if d == "output"]
    # By connections of the bind, which are of the very instance: a name from within would find any instance's.
    told = [*(("in", n, f"$bits({n})") for n in inputs), *(("out", n, f"$bits({n})") for n in outputs)]
    told += [("parameter", n, n) for n in parameters_of(rtl, module, known)]
    declared = ", ".join(f"parameter int P{i} = 0" for i in range(len(told)))
    given = ", ".join(f".P{i}({value})" for i, (_, _, value) in enumerate(told))
    lines = "\n        ".join(f'$display("kage_ports %m {what} {n} %0d", P{i});' for i, (what, n, _) in enumerate(told))
    ins, outs = ", ".join(inputs), ", ".join(outputs)
    path.write_text(f"""// Made by build.py --ports {module}.
`default_nettype none
module kage_ports #(parameter int IN = 1, parameter int OUT = 1, {declared}) (
    input wire logic clk_i, input wire logic rst_ni, input wire logic [IN-1:0] in_i, input wire logic [OUT-1:0] out_i
);
  logic told_q = 1'b0;
  always @(posedge clk_i) begin
    if (rst_ni || told_q) begin
      if (!told_q) begin
        {lines}
      end
      told_q <= 1'b1;
      $display("kage_ports %m clock %h %h", in_i, out_i);
    end
  end
endmodule
bind {module} kage_ports #(.IN($bits({{{ins}}})), .OUT($bits({{{outs}}})), {given}) u_kage_ports (
    .clk_i(clk_i), .rst_ni(rst_ni), .in_i({{{ins}}}), .out_i({{{outs}}})
);
`default_nettype wire
""")
