#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every file of assimp-testmodels through `kage render --size 64x48`: each is rendered (exit 0) or refused (exit 2, one line on
# standard error, no picture left), within a time limit. A signal, a hang, another exit code or more to say is a failure.
#
#   assimp_models.sh KAGE [SOURCE_DIR [MODELS_DIR]]
#
# SOURCE_DIR is not used; it is what every script of this folder is given.
set -euo pipefail
kage=${1:?the kage program}
models=${3:-/usr/share/assimp/models}
if [ ! -d "$models" ]; then
  echo "$models does not exist: tools/deps test installs it (Debian package assimp-testmodels)"
  [ -n "${KAGE_WITHOUT_MESHES+set}" ]
  exit
fi
work=$(mktemp -d "${TMPDIR:-/tmp}/kage-models-XXXXXX")
trap 'rm -rf "$work"' EXIT

# Small limits, so that the few files that exhaust them do so soon.
export KAGE_IMPORT_SECONDS=${KAGE_IMPORT_SECONDS:-20} KAGE_IMPORT_MIB=${KAGE_IMPORT_MIB:-1024}
limit=90

# one NUMBER FILE: a line of verdict in $work/NUMBER.verdict
one() {
  local number=$1 file=$2 out="$work/$1.out" err="$work/$1.err" code=0 verdict lines
  timeout -k 5 "$limit" "$kage" render "$file" --size 64x48 --frames 1 --out "$out" >"$work/$number.txt" 2>"$err" || code=$?
  # A sanitizer's allocator ends the import process on a request that is too large, and says so: not an error of ours.
  if grep -q 'AddressSanitizer: allocator is out of memory' "$err"; then
    tail -n 1 "$err" >"$err.last"
    mv "$err.last" "$err"
  fi
  lines=$(wc -l <"$err")
  case $code in
    0) if [ -n "$(find "$out" -name '*.png' -size +0 2>/dev/null | head -n 1)" ]; then verdict=rendered; else verdict="FAILED (exit 0 without a picture)"; fi ;;
    2) if [ "$lines" -ne 1 ]; then verdict="FAILED (exit 2 with $lines lines on standard error)"
       elif [ -e "$out" ] && [ -n "$(find "$out" -type f | head -n 1)" ]; then verdict="FAILED (exit 2 and a file left)"
       else verdict=refused; fi ;;
    124 | 137) verdict="FAILED (longer than $limit s)" ;;
    *) verdict="FAILED (exit $code)" ;;
  esac
  printf '%s\t%s\t%s\n' "$verdict" "$file" "$(head -n 1 "$err")" >"$work/$number.verdict"
  rm -rf "$out"
}
export -f one
export kage work limit

# Everything but what is text about models or a picture for them.
find "$models" -type f ! -iname '*.txt' ! -iname '*.png' ! -iname '*.jpg' ! -iname '*.bmp' ! -iname '*.tga' ! -iname '*.dds' \
  ! -iname '*.glsl' ! -iname '*.vert' ! -iname '*.frag' ! -iname '*.md' | sort | awk '{ print NR; print }' |
  xargs -d '\n' -n 2 -P "${KAGE_TEST_JOBS:-2}" bash -c 'one "$@"' one

cat "$work"/*.verdict >"$work/all"
rendered=$(grep -c '^rendered' "$work/all" || true)
refused=$(grep -c '^refused' "$work/all" || true)
failed=$(grep -c '^FAILED' "$work/all" || true)
grep '^FAILED' "$work/all" || true
echo "$((rendered + refused + failed)) files: $rendered rendered, $refused refused, $failed failed"
[ "$failed" -eq 0 ] && [ "$rendered" -gt 0 ]
