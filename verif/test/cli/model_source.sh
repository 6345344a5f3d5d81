#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A kept RTL model is of the sources whose hash its name is, though someone changes them while it is built.
. "$(dirname "$0")/common.bash"

data_copy data
echo '{MAX_WIDTH: 64, LANES: 2, BEAT_WORDS: 1}' >small.yaml
expect 0 "$kage" stream courtyard --size 64x48 --frames 1 --config small.yaml --out s.kage
export KAGE_DATA_DIR=$PWD/data XDG_CACHE_HOME=$PWD/cache

cp -r data/rtl sound
# The environment of make and compilers is no part of the name, so the model must not depend on it.
CXXFLAGS=--no-such-flag OPT=--no-such-flag LDFLAGS=--no-such-flag MAKEFLAGS=n "$kage" model small.yaml >built 2>&1 &
until compgen -G 'cache/kage/models/*.lock' >/dev/null || ! kill -0 $! 2>/dev/null; do sleep 0.05; done
[ -z "$(find cache -name '*.so')" ] || fail "the model was there before its sources could change"
put_fault wrong_compare data
wait $! || fail "the model was not built: $(cat built)"
rm -r data/rtl && mv sound data/rtl
expect 0 "$kage" cosim s.kage --no-report --out out
[ "$(find cache -name '*.so' | wc -l)" = 1 ] || fail "the sources are as they were, and there are these models: $(find cache -name "*.so")"

# A model that is there is found without Python. Its key is of the model's sources (driver/sources.yaml), and of nothing else.
mkdir tools && printf '#!/bin/sh\necho "python3 runs"\nexit 1\n' >tools/python3 && chmod +x tools/python3
# there FILE: whether a model is there once a line more is in the file, which is taken away again.
there() {
  local rc=0
  printf '\n' >>"data/$1"
  PATH=$PWD/tools:$PATH "$kage" cosim s.kage --no-report --out out >said 2>&1 || rc=$?
  cp "$source/$1" "data/$1"
  [ $rc = 0 ] || grep -q 'the build failed: python3 runs' said || fail "$1 changes, and: $(cat said)"
  return $rc
}
for file in rtl/defs/stages.yaml rtl/defs/configs.yaml verif/cosim/diverge/monitors/tree_core_monitor.sv verif/cosim/model/faults.yaml; do
  there $file || fail "another $file asks for another model"
done
for file in rtl/ram_1r1w.sv rtl/include/kage_illegal.svh rtl/include/generated/kage_widths.svh rtl/defs/kage.yaml \
  verif/cosim/model/driver/flow.hpp verif/cosim/model/driver/steps.py verif/cosim/model/driver/sources.yaml; do
  ! there $file || fail "another $file asks for no other model"
done

# Who stands in a tree with another rtl/ hears, once, that it is not the one in use; who does not hears nothing.
mkdir -p other/rtl/include
touch other/rtl/kage_top.sv
note="kage: note: the RTL is that of $PWD/data/rtl, not of $PWD/other/rtl (KAGE_DATA_DIR=$PWD/other takes the latter)"
stands() { # FOLDER NOTE COMMAND...: what the command says on standard error, run in FOLDER
  local folder=$1 said=$2
  shift 2
  (cd "$folder" && "$@" >/dev/null 2>"$temp/notes") || fail "in $folder: $* failed: $(cat notes)"
  [ "$(cat notes)" = "$said" ] || fail "in $folder: $* says '$(cat notes)' on standard error"
}
ln -s data linked
for folder in other other/rtl/include; do stands $folder "$note" "$kage" model "$temp/small.yaml"; done
stands other "$note" "$kage" cosim "$temp/s.kage" --no-report --out "$temp/out"
stands other "" "$kage" explain "$temp/s.kage" --pixel 3,3
for folder in . data data/rtl/include linked/rtl; do stands $folder "" "$kage" model "$temp/small.yaml"; done

# It is also of the tools that it is made by; a compiler may be several words.
VERILATOR=$PWD/nowhere trouble "verilator: not found" "$kage" cosim s.kage --no-report --out out
CXX="env c++ -DNOTHING" expect 0 "$kage" cosim s.kage --no-report --out out --json j.json
[ "$(find cache -name '*.so' | wc -l)" = 2 ] || fail "other tools, and the model is that of before"
json j.json "any('c++' in v or 'g++' in v or 'clang' in v for v in j['versions'])"

# A source that does not build is named where a person finds it.
sed -i 's/^module frame_control/modul frame_control/' data/rtl/frame_control.sv
trouble "$PWD/data/rtl/frame_control.sv:" "$kage" model small.yaml
[ -z "$(find cache -name '*.[0-9]*' -type d)" ] || fail "something is left of a build"
done_testing
