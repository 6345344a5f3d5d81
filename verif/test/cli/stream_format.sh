#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/stream.md: the commands of its examples print the line it reads aloud, by spans and by polygons, and the front end makes
# the spans at the tokens that the page names. Page docs/stream-files.md: its command makes the bytes it shows, and its Python
# reads them, and refuses a changed file.
. "$(dirname "$0")/common.bash"

# block PAGE LANGUAGE HEADING: the page's first code block of that language from that heading on.
block() {
  awk -v lang="\`\`\`$2" -v from="$3" '$0 == from { on = 1 } on && inside && /^```$/ { inside = 0; next }
    on && !inside && /^```/ { inside = 1; take = ($0 == lang && !seen++); next } inside && take' "$source/docs/$1.md"
}

mkdir bin && ln -s "$kage" bin/kage
read_aloud() { # HEADING LINES: what the commands under it print is the line that is shown under it
  block stream sh "$1" >commands
  expect 0 env PATH="$temp/bin:$PATH" sh -e commands
  sed -n '/EOL 0$/,$p' stdout >made
  block stream "" "$1" >shown
  [ "$(wc -l <shown)" = "$2" ] || fail "no line in docs/stream.md, $1"
  diff shown made || fail "docs/stream.md, $1, shows another line than its commands print"
}
read_aloud "## One line, read aloud" 13
read_aloud "### The same line, read aloud" 15
expect 0 "$kage" diff line.kage polygons.kage
expect 0 "$kage" explain polygons.kage --pixel 25,1
at=$(sed -n 's/^ *\([0-9]*\)  \([A-Z]*\).*, made by the front end$/\1 \2/p' stdout | paste -sd, -)
[ "$at" = "12 OP,14 SP,14 EV,19 SP,23 SP,24 EV,24 RESOLVE" ] || fail "the front end makes, at other tokens than docs/stream.md says: $at"

block stream-files sh "## By hand" >commands
[ "$(wc -l <commands)" = 2 ] || fail "not two commands: $(cat commands)"
expect 0 env PATH="$temp/bin:$PATH" sh -e commands
sed -n '/^000000/,$p' stdout >made
block stream-files "" "## By hand" >shown
[ "$(wc -l <shown)" -gt 10 ] || fail "no dump in docs/stream-files.md"
diff shown made || fail "docs/stream-files.md shows other bytes than its command makes"

block stream-files python "## By hand" >read.py
expect 0 python3 read.py pixel.kage
[ "$(cat stdout)" = "frame 0: 1x1, 10 words" ] || fail "the reader prints $(cat stdout)"
grep -qF "$(cat stdout)" "$source/docs/stream-files.md" || fail "docs/stream-files.md says that the reader prints something else"
expect 0 "$kage" stream courtyard --size 96x64 --frames 3 --out c.kage
expect 0 python3 read.py c.kage
[ "$(grep -c ': 96x64, ' stdout)" = 3 ] || fail "the reader finds other frames: $(cat stdout)"
for at in 20 310 326 340 381; do
  python3 -c "import sys; d=bytearray(open('pixel.kage','rb').read()); d[int(sys.argv[1])]^=1; open('bad.kage','wb').write(d)" $at
  expect 1 python3 read.py bad.kage
  trouble bad.kage "$kage" info bad.kage
done
done_testing
