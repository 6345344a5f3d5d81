# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154 # $kage is common.bash's
# Packs of kage vectors, for the tests that write them. Read behind common.bash.

pack() { "$kage" vectors "$@" --json pack.json; }

make() { # FOLDER SCENE ARGUMENT...: a pack, verified
  expect 0 pack "${@:2}" --out "$1"
  expect 0 "$kage" vectors --check "$1"
}
