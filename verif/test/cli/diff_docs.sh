#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/diff.md: its commands print what it shows, and the heat map in it is the one they make.
. "$(dirname "$0")/common.bash"

mkdir bin && ln -s "$kage" bin/kage
python3 "$source/verif/test/cli/shown.py" "$source/docs/diff.md" 1 1 1 1 1 || fail "docs/diff.md shows something else than its commands print"
expect 0 "$kage" diff heat.png "$source/docs/images/diff-heat.png"
done_testing
