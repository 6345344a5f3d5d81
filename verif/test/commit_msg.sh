#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The hook on commit messages refuses what it says, and nothing else. usage: commit_msg.sh SOURCE
set -euo pipefail
hook=$1/.githooks/commit-msg
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
# expect RC CHANGED MESSAGE
expect() {
  local rc=0
  printf '%b' "$3" >"$temp/message"
  "$hook" "$temp/message" "$2" 2>"$temp/said" || rc=$?
  [ $rc = "$1" ] || { echo "exit code $rc in place of $1 for '$3' on $2: $(cat "$temp/said")" >&2; exit 1; }
  [ $rc = 0 ] || [ "$(wc -l <"$temp/said")" = 1 ] || { echo "not one line for '$3'" >&2; exit 1; }
}
long=$(printf 'x%.0s' {1..72})
expect 0 cli/a.cpp "$long\n\nWhy.\n"
expect 1 cli/a.cpp "${long}x\n\nWhy.\n"
expect 1 docs/a.md "${long}x\n"
expect 0 $'docs/a.md\nREADME.md' 'Say it better\n'
expect 1 $'docs/a.md\nref/a.cpp' 'Say it better\n'
expect 1 ref/a.cpp 'Mend it\n\nSigned-off-by: N N <n@example.org>\n'
expect 1 ref/a.cpp 'Mend it\n\n# Please enter the commit message\n'
expect 0 ref/a.cpp 'Mend it\n\nIt was wrong.\n\nSigned-off-by: N N <n@example.org>\n'
