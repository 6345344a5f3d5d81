#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Large libraries are bound by those commands alone that need them, and a plugin that is missing or of another build is a line.
. "$(dirname "$0")/common.bash"

# Libraries that every command binds: OpenImageIO and Assimp with all that they stand on were 264 libraries, and 0.3 s.
bound=$(LD_TRACE_LOADED_OBJECTS=1 "$kage" | grep -v -E 'asan|ubsan')
[ "$(wc -l <<<"$bound")" -le 20 ] || fail "every command binds: $bound"
if grep -E 'OpenImageIO|assimp|OpenEXR|libav' <<<"$bound"; then fail "every command binds what few need"; fi

# Without plugins: scenes of glTF and OBJ, pictures as PNG, streams.
empty=$PWD/empty
mkdir empty
without() { KAGE_PLUGIN_DIR=$empty "$@"; }
expect 0 without "$kage" render courtyard --size 64x48 --frames 1 --out out
expect 0 without "$kage" stream courtyard --size 64x48 --frames 1 --out s.kage
expect 0 without "$kage" info s.kage
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >mesh.obj
expect 0 without "$kage" render mesh.obj --size 64x48 --frames 1 --out out
cube=/usr/share/glmark2/models/cube.3ds
trouble "$empty/libkage_meshes.so: cannot open shared object file: No such file or directory, and files other than glTF 2.0, OBJ, PLY, STL and OFF are read with it" \
  without "$kage" render "$cube" --size 64x48 --frames 1 --out out
# PNG is read by libpng alone, and comes out the same.
expect 0 "$kage" render courtyard --size 64x48 --frames 2 --out two
expect 1 "$kage" diff two/courtyard_0000.png two/courtyard_0001.png --json with.json --out with.png
expect 1 without "$kage" diff two/courtyard_0000.png two/courtyard_0001.png --json without.json --out without.png
cmp with.json without.json || fail "without the plugin the difference is another"
cmp with.png without.png || fail "without the plugin the heat map is another"
cp out/courtyard_0000.png png.exr
expect 0 without "$kage" diff png.exr out/courtyard_0000.png
printf 'P6 1 1 255 abc' >one.ppm
trouble "$empty/libkage_pictures.so: cannot open shared object file: No such file or directory, and pictures other than PNG are read, and EXR is written, with it (OpenImageIO; Debian: libopenimageio-dev)" \
  without "$kage" diff one.ppm one.ppm
trouble "$empty/libkage_pictures.so: cannot open" without "$kage" render courtyard --size 64x48 --frames 1 --exr --out exr
[ ! -e exr ] || fail "a picture that cannot be written leaves a folder"
expect 0 "$kage" diff out/courtyard_0000.png out/courtyard_0000.png
expect 0 "$kage" render "$cube" --size 64x48 --frames 1 --out out

# Damaged, and of another build.
printf '#!/bin/sh\nexit 4\n' >empty/kage-import
chmod +x empty/kage-import
trouble "courtyard.gltf: $empty/kage-import: is not of kage" without "$kage" render courtyard --size 64x48 --frames 1 --out out
rm empty/kage-import
echo junk >empty/libkage_pictures.so
trouble "$empty/libkage_pictures.so: file too short, and pictures other than PNG are read" without "$kage" diff out/courtyard_0000.png out/courtyard_0000.png
version=$("$kage" --version)
cat >other.c <<C
struct head { const char* version; void* functions[9]; };
const struct head* kage_pictures_table(void) { static const struct head h = {"${version#kage }"}; return &h; }
C
cc -shared -fPIC other.c -o empty/libkage_pictures.so || fail "no compiler" # the same version, another table
trouble "$empty/libkage_pictures.so: is not of kage" without "$kage" diff out/courtyard_0000.png out/courtyard_0000.png
done_testing
