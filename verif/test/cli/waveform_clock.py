#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""waveform_clock.py REPORT.json FILE.gtkw [LANES]: whether the waveform agrees with the report at the clock that the
save file marks. There pixel_banked writes the pixel, and in it the wrong value; a clock before and a clock behind it
does not. Prints how many frames have ended at the core's input before, as far as the waveform goes back.
"""

import json
import re
import sys

import fst

report, save, lanes = json.load(open(sys.argv[1])), open(sys.argv[2]).read(), int(sys.argv[3])
wrong = report["first_difference"]["divergence"]
wave = fst.Fst(re.search(r'^\[dumpfile\] "(.*)"$', save, re.M)[1])
marker = int(re.search(r"^\*-4\.0 (\d+)$", save, re.M)[1])
clock = (marker + 1) // 2


def net(name):
    (full,) = (n for n in wave.nets if re.fullmatch(rf"top\.kage_top\.{name}(\[\d+:0\])?", n))
    return wave.of(full), wave.bits[wave.nets[full]]


def fail(why):
    sys.exit(f"{sys.argv[2]}: clock {clock}, {wrong['text']}: {why}")


pixels = r"u_pixels\.gen_banked\.u_pixels\."
valid, stages = net(pixels + "valid")
taken, address, (after, bits) = net(pixels + "now_lanes")[0], net(pixels + "now_addr")[0], net(pixels + "next")
z_bits, channels = report["config"]["Z_BITS"], report["config"]["CHANNELS"]


def writes(time):
    """The value that the edge that follows writes to the pixel; nothing if it writes none."""
    lane = wrong["x"] % lanes
    if not fst.at(valid, time) >> stages - 1 or not fst.at(taken, time) >> lane & 1:
        return None
    if fst.at(address, time) * lanes + lane != wrong["x"]:
        return None
    pixel = fst.at(after, time) >> bits // lanes * lane
    color = [str(pixel >> z_bits + 8 * c & 255) for c in range(channels)]
    return {"z": str(pixel & (1 << z_bits) - 1), "color": ",".join(color)}


clk = net("clk_i")[0]
if fst.at(clk, marker) or not fst.at(clk, marker + 1):
    fail("the marker does not stand right before an edge")
if writes(marker) is None:
    fail("the pixel is not written")
if wrong["field"] not in writes(marker) or writes(marker)[wrong["field"]] != wrong["actual"]:
    fail(f"it is {writes(marker)}")
if any(writes(marker + step) for step in (-2, 2)):
    fail("a clock beside it writes the pixel too: the test would not see another clock")
beat = [net(f"s_axis_{n}")[0] for n in ("tvalid_i", "tready_o", "tlast_i")]
times = range(wave.first() + 1 | 1, marker, 2)
print(sum(all(fst.at(n, time) for n in beat) for time in times))
