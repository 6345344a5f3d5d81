#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tools/words.py finds what must be read twice, and nothing else. usage: words.sh SOURCE
set -euo pipefail
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
long=$(printf 'word %.0s' {1..36})
# expect RC TEXT
expect() {
  local rc=0
  printf '%b' "$2" >"$temp/page.md"
  python3 "$1/tools/words.py" "$temp/page.md" >"$temp/said" || rc=$?
  [ $rc = "$3" ] || { echo "exit code $rc in place of $3 for: $2" >&2; cat "$temp/said" >&2; exit 1; }
}
expect "$1" "A $long.\n" 1
expect "$1" "A ${long% word }.\nAnother.\n" 1
expect "$1" "* An entry.\n* A $long\n  and more.\n" 1
expect "$1" "| a cell | A $long |\n" 1
expect "$1" "What it gives is a span.\n" 1
expect "$1" "A span. Of these the first counts.\n" 1
expect "$1" "That of a frame is longer.\n" 1
expect "$1" "Those without a light are dark.\n" 1
expect "$1" "What does it give? That file has it. Those spans are dark.\n" 0
expect "$1" "Half of the words are here: $(printf 'word %.0s' {1..20}).\nThe rest: $(printf 'word %.0s' {1..20}).\n" 0
expect "$1" "\`\`\`\nWhat it is $long\n\`\`\`\n" 0
expect "$1" "| a | $(printf 'word %.0s' {1..20}); $(printf 'word %.0s' {1..20}) |\n" 0
expect "$1" "[$(printf 'word %.0s' {1..30})](a.md#b-c) \`a b c d e f g h\`\n" 0
