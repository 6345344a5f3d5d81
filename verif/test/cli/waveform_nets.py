#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""waveform_nets.py FILE.gtkw: whether the waveform that a GTKWave save file names has all of the nets that it names, and none of
a monitor."""

import re
import sys

import fst

save = open(sys.argv[1]).read()
there = fst.Fst(re.search(r'^\[dumpfile\] "(.*)"$', save, re.M)[1]).nets
wanted = re.findall(r"^(\w+\..*)$", save, re.M)
missing = [n for n in wanted if n not in there]
if own := [n for n in there if "monitor" in n]:
    sys.exit(f"{sys.argv[1]}: {len(own)} nets of monitors, such as {own[0]}")
if missing or len(wanted) < 15:
    sys.exit(f"{sys.argv[1]}: {len(wanted)} nets, of which the waveform lacks {missing}")
