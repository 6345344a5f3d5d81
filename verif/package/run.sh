#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the build into a temporary prefix, then configures, builds and runs a project that knows nothing but that prefix.
# What docs/building.md and docs/order.md show of that project must be in it.
# usage: run.sh BUILD SOURCE CXX
set -euo pipefail
[ $# = 3 ] || { echo "usage: run.sh BUILD SOURCE CXX" >&2; exit 2; }
build=$1 source=$2 cxx=$3
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
cmake --install "$build" --prefix "$temp/prefix" >/dev/null
cmake -S "$source/verif/package" -B "$temp/build" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$temp/prefix" ${KAGE_PACKAGE_FLAGS:+-DCMAKE_CXX_FLAGS="$KAGE_PACKAGE_FLAGS"}
cmake --build "$temp/build"
KAGE_DATA_DIR="$temp/prefix/share/kage" "$temp/build/consumer"
"$temp/build/order_consumer"
for file in rtl/defs/kage.yaml rtl/configs.yaml; do
  [ -e "$temp/prefix/share/kage/$file" ] || { echo "not installed: share/kage/$file" >&2; exit 1; }
done
shows() { # DOC FILE: each line of the code block behind the comment that names the file is in the file
  awk -v mark="<!-- $2 has these lines -->" '$0 == mark { on = 1; next } on && /^```$/ { exit } on && !/^```/' "$source/$1" >"$temp/shown"
  [ "$(grep -c . "$temp/shown")" -gt 3 ] || { echo "$1 shows nothing of $2" >&2; exit 1; }
  while IFS= read -r line; do
    grep -qF -- "$(sed 's/^ *//' <<<"$line")" "$source/$2" || { echo "$1 shows '$line', which $2 has not" >&2; exit 1; }
  done <"$temp/shown"
}
shows docs/building.md verif/package/golden.cpp
shows docs/order.md verif/package/order.cpp
# The installed program, moved to another prefix, finds RTL, scenes and model builder beside itself.
mv "$temp/prefix" "$temp/moved"
if [ -x "$temp/moved/bin/kage" ]; then
  cd "$temp"
  env -u KAGE_DATA_DIR moved/bin/kage cosim courtyard --size 64x48 --frames 1 --out pictures
  [ -s pictures/report.html ] || { echo "no report of an installed kage" >&2; exit 1; }
  env -u KAGE_DATA_DIR moved/bin/kage stream courtyard --size 64x48 --frames 1 --out courtyard.kage
  build/golden_consumer courtyard.kage >courtyard.ppm
  moved/bin/kage stream courtyard --size 64x48 --frames 1 --config default --out default.kage
  LD_LIBRARY_PATH=$(dirname "$(find moved -name libkage_golden.so)") build/c_consumer default.kage
  moved/bin/kage diff courtyard.ppm pictures/courtyard_0000.png
fi
