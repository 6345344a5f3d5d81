#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tools/words.py finds what must be read twice, and nothing else. usage: words.sh SOURCE
set -euo pipefail
words=$1/tools/words.py temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
cd "$temp"
mkdir cli
long=$(printf 'word %.0s' {1..36})
half=$(printf 'word %.0s' {1..20})
# expect FILE TEXT RC
expect() {
  local rc=0
  printf '%b' "$2" >"$1"
  python3 "$words" "$1" >said || rc=$?
  [ $rc = "$3" ] || { echo "$1: exit code $rc in place of $3 for: $2" >&2; cat said >&2; exit 1; }
}
expect page.md "A $long.\n" 1
expect page.md "A ${long% word }.\nAnother.\n" 1
expect page.md "* An entry.\n* A $long\n  and more.\n" 1
expect page.md "| a cell | A $long |\n" 1
expect page.md "What it gives is a span.\n" 1
expect page.md "A span. Of these the first counts.\n" 1
expect page.md "That of a frame is longer.\n" 1
expect page.md "Those without a light are dark.\n" 1
expect page.md "What does it give? That file has it. Those spans are dark.\n" 0
expect page.md "Half of the words are here: $half.\nThe rest: $half.\n" 0
expect page.md "\`\`\`\nWhat it is $long\n\`\`\`\n" 0
expect page.md "| a | $half; $half |\n" 0
expect page.md "[$(printf 'word %.0s' {1..30})](a.md#b-c) \`a b c d e f g h\`\n" 0
for file in a.cpp a.hpp a.sv a.h; do
  expect $file "int a;\n// What it gives\n// is a span.\n" 1
  expect $file "/* A span.\n * Of these the first. */\n" 1
  expect $file "int a;  // What it gives.\nint b;  // a span\n" 1
  expect $file "// A $half\n// $half.\n" 1
  expect $file "int a;  // $half\nint b;  // $half\n" 0
  expect $file "// $half\n//\n// $half\n" 0
  expect $file "// one    $half\n// two    $half\n" 0
  expect $file "f(\"What it gives is a span.\");\n" 0
done
expect cli/a.cpp "f(\"What it gives \"\n  \"is a span.\");\n" 1
expect cli/a.cpp "f(\"$half\\\\n\"\n  \"$half\");\n" 0
expect a.py "\"\"\"What it gives is a span.\"\"\"\n" 1
expect a.py "def f():\n    \"\"\"Of these the first.\"\"\"\n" 1
expect a.py "# A $half\n# $half\n" 1
expect a.py "a = \"What it gives is a span.\"\n" 0
expect tool "#!/usr/bin/env python3\n\"\"\"What it gives is a span.\"\"\"\n" 1
for file in a.sh a.cmake a.yaml; do
  expect $file "a b # What it's made of\n" 1
  expect $file "a 'b' \"c\" # What {it} is\n" 1
  expect $file "# What it gives\n# is a span.\n" 1
  expect $file "a b # Of these the first.\n" 1
  expect $file "a b \"# What it is\"\n" 0
done
