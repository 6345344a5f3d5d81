#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tools/dead-cores tells a test that fails with a dead core, and its rows are what docs/schema says.
# usage: dead_cores.sh SOURCE BUILD
set -euo pipefail
source=$1 build=$2
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
mkdir "$temp/json"
python3 "$source/tools/dead_cores.py" "$source" "$build" --tests '^rtl/families_39_40_41_narrow1$' --fault dead_silent --json "$temp/json/dead-cores.1.json"
python3 "$source/verif/test/cli/schema.py" "$source/docs/schema" "$temp/json"
