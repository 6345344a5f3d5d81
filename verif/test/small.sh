#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A build without OpenImageIO asks for neither it nor what the picture plugin needs beside it, and has no such plugin.
# cli/plugins tries the program without it. usage: small.sh SOURCE
set -euo pipefail
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
configure() { cmake -S "$1" -B "$temp/$2" -G Ninja -DCMAKE_BUILD_TYPE=Release -DKAGE_BENCH=OFF "${@:3}" >"$temp/said" 2>&1; }
configure "$1" small -DKAGE_TESTS=OFF -DKAGE_OPENIMAGEIO=OFF -DCMAKE_DISABLE_FIND_PACKAGE_{OpenImageIO,LibWebP,TIFF}=ON ||
  { cat "$temp/said" >&2; exit 1; }
if grep -qE 'OpenImageIO|kage_pictures|libwebp|libtiff' "$temp/small/build.ninja"; then echo "small.sh: the build knows OpenImageIO" >&2; exit 1; fi
grep -q kage_meshes "$temp/small/build.ninja" || { echo "small.sh: the build has no plugins at all" >&2; exit 1; }
# Tests need it, and say so.
if configure "$1" tests -DKAGE_TESTS=ON -DKAGE_OPENIMAGEIO=OFF; then echo "small.sh: tests are built without OpenImageIO" >&2; exit 1; fi
grep -q "KAGE_TESTS needs OpenImageIO (Debian: libopenimageio-dev)" "$temp/said" || { cat "$temp/said" >&2; exit 1; }
