#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the build into a temporary prefix, then configures, builds and runs a project that knows nothing but that prefix. The
# lines of that project that docs/building.md and docs/order.md show must be in it.
# usage: run.sh BUILD SOURCE CXX
set -euo pipefail
[ $# = 3 ] || { echo "usage: run.sh BUILD SOURCE CXX" >&2; exit 2; }
build=$1 source=$2 cxx=$3
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
cmake --install "$build" --prefix "$temp/prefix" >/dev/null
cmake -S "$source/verif/test/package" -B "$temp/build" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$temp/prefix" ${KAGE_PACKAGE_FLAGS:+-DCMAKE_CXX_FLAGS="$KAGE_PACKAGE_FLAGS"}
cmake --build "$temp/build"
KAGE_DATA_DIR="$temp/prefix/share/kage" "$temp/build/consumer"
"$temp/build/order_consumer"
# Each header can be included alone, and names no type that is not in one of them.
headers=$(dirname "$(find "$temp/prefix" -path '*/kage/core.hpp')")
for header in "$headers"/*.h "$headers"/*.hpp; do
  # shellcheck disable=SC2086
  "$cxx" -std=c++20 ${KAGE_PACKAGE_FLAGS:-} -fsyntax-only -x c++ -I"${headers%/kage}" - <<<"#include <kage/${header##*/}>" ||
    { echo "installed: ${header##*/} cannot be included alone" >&2; exit 1; }
done
declared=0
while read -r kind name; do
  grep -qE "^$kind $name( : .*)? \{" "$headers"/*.hpp || { echo "installed: $kind $name is declared and not defined" >&2; exit 1; }
  declared=$((declared + 1))
done < <(sed -nE 's/^(class|struct) ([A-Za-z]+);.*/\1 \2/p' "$headers"/*.hpp)
[ $declared -gt 0 ] || { echo "no header declares what another defines: the check above sees nothing" >&2; exit 1; }
for file in rtl/defs/kage.yaml rtl/defs/configs.yaml verif/cosim/model/cells/ice40.v verif/cosim/model/driver/netlist.py verif/board/sim/build_board.py constraints/boards/boards.yaml; do
  [ -e "$temp/prefix/share/kage/$file" ] || { echo "not installed: share/kage/$file" >&2; exit 1; }
done
# The installed pages are whole: each link of each page leads to a file that is there.
doc=$temp/prefix/share/doc/kage
[ -d "$doc" ] || doc=$(dirname "$(find "$temp/prefix" -name README.md -path '*doc*' | head -n 1)")
links=0
while IFS=: read -r page link; do
  [ -e "$(dirname "$page")/$link" ] || { echo "installed: $page: $link: no such file" >&2; exit 1; }
  links=$((links + 1))
done < <(grep -roE '\]\([A-Za-z][A-Za-z0-9_./-]*' --include=*.md "$doc" | sed 's/:\](/:/' | grep -vE ':(https?|int)$')
[ $links -gt 60 ] || { echo "installed pages have only $links links" >&2; exit 1; }
for file in man/man1/kage.1 bash-completion/completions/kage zsh/site-functions/_kage doc/kage/examples/c/pixel_check.c; do
  [ -s "$temp/prefix/share/$file" ] || { echo "not installed: share/$file" >&2; exit 1; }
done
# Without CMake: pkg-config knows what to compile and link with.
pc=$(dirname "$(find "$temp/prefix" -name kage.pc)")
if command -v pkg-config >/dev/null; then
  export PKG_CONFIG_PATH=$pc
  # shellcheck disable=SC2046
  "$cxx" -std=c++20 ${KAGE_PACKAGE_FLAGS:-} "$source/verif/test/package/golden.cpp" -o "$temp/golden_pc" $(pkg-config --cflags --libs kage)
  # shellcheck disable=SC2046
  "$cxx" -std=c++20 ${KAGE_PACKAGE_FLAGS:-} "$source/verif/test/package/order.cpp" -o "$temp/order_pc" $(pkg-config --cflags --libs kage-order)
  "$temp/order_pc"
  if [ -f "$pc/kage-cosim.pc" ]; then
    # shellcheck disable=SC2046
    "$cxx" -std=c++20 ${KAGE_PACKAGE_FLAGS:-} "$source/verif/test/package/cosim.cpp" -o "$temp/cosim_pc" $(pkg-config --cflags --libs kage-cosim)
  fi
  # shellcheck disable=SC2046
  [ -z "$(LD_TRACE_LOADED_OBJECTS=1 "$temp/golden_pc" | grep -E 'OpenImageIO|assimp')" ] || { echo "who links kage binds OpenImageIO" >&2; exit 1; }
fi
shows() { # DOC FILE: each line of the code block behind the comment that names the file is in the file
  awk -v mark="<!-- $2 has these lines -->" '$0 == mark { on = 1; next } on && /^```$/ { exit } on && !/^```/' "$source/$1" >"$temp/shown"
  [ "$(grep -c . "$temp/shown")" -gt 3 ] || { echo "$1 shows nothing of $2" >&2; exit 1; }
  while IFS= read -r line; do
    grep -qF -- "$(sed 's/^ *//' <<<"$line")" "$source/$2" || { echo "$1 shows '$line', which $2 has not" >&2; exit 1; }
  done <"$temp/shown"
}
shows README.md verif/test/package/draw.cpp
shows docs/api.md verif/test/package/cosim.cpp
shows docs/building.md verif/test/package/golden.cpp
shows docs/order.md verif/test/package/order.cpp
# The installed program, moved to another prefix, finds RTL, scenes and model builder beside itself.
mv "$temp/prefix" "$temp/moved"
if [ -x "$temp/moved/bin/kage" ]; then
  cd "$temp"
  # Its own plugins, though those of the build are there too.
  for plugin in pictures meshes; do
    [ -n "$(find moved -path "*/kage/libkage_$plugin.so")" ] || { echo "not installed: libkage_$plugin.so" >&2; exit 1; }
  done
  [ -n "$(find moved -path "*/kage/kage-import" -executable)" ] || { echo "not installed: kage-import" >&2; exit 1; }
  env -u KAGE_DATA_DIR moved/bin/kage cosim courtyard --size 64x48 --frames 1 --out pictures
  [ -s pictures/report.html ] || { echo "no report of an installed kage" >&2; exit 1; }
  env -u KAGE_DATA_DIR moved/bin/kage stream courtyard --size 64x48 --frames 1 --out courtyard.kage
  build/golden_consumer courtyard.kage >courtyard.ppm
  # The whole way by the library, to the very picture that the program draws.
  KAGE_DATA_DIR=$temp/moved/share/kage build/draw_consumer courtyard drawn.png
  # Another's program finds it beside kage's data, where the build is not there to have it.
  if unshare -m true 2>/dev/null; then
    rm drawn.png
    unshare -m sh -c 'mount -t tmpfs none "$1" && KAGE_DATA_DIR=$2/moved/share/kage exec "$2/build/draw_consumer" courtyard drawn.png' - "$build/lib/kage" "$temp"
  fi
  moved/bin/kage render courtyard --frames 1 --size 640x480 --out drawn
  moved/bin/kage diff drawn.png drawn/courtyard_0000.png
  moved/bin/kage stream courtyard --size 64x48 --frames 1 --config default --out default.kage
  LD_LIBRARY_PATH=$(dirname "$(find moved -name libkage_golden.so)") build/c_consumer default.kage
  # A co-simulation in another's program, and what it says of sound and of broken RTL.
  export KAGE_DATA_DIR=$temp/moved/share/kage
  said=$(build/cosim_consumer)
  [ "$said" = "same: 3 frames, 57600 pixels" ] || { echo "cosim_consumer says '$said'" >&2; exit 1; }
  said=$(build/cosim_consumer wrong_compare) && { echo "cosim_consumer finds no fault" >&2; exit 1; }
  grep -q '^first divergence: .*(rtl/' <<<"$said" || { echo "cosim_consumer blames nothing: '$said'" >&2; exit 1; }
  build/cosim_consumer no_such_fault 2>said && { echo "cosim_consumer takes any fault" >&2; exit 1; }
  grep -q no_such_fault said || { cat said >&2; exit 1; }
  unset KAGE_DATA_DIR
  LD_DEBUG=files LD_DEBUG_OUTPUT=$temp/bound moved/bin/kage diff courtyard.ppm pictures/courtyard_0000.png
  grep -q "calling init: $temp/moved/.*/libkage_pictures.so" "$temp"/bound.* || { echo "an installed kage opens another's plugin" >&2; exit 1; }
fi
