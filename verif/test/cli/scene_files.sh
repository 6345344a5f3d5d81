#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Scene files of others: what they may not read, what they may not require, what is told of them, and kage info of them.
. "$(dirname "$0")/common.bash"

# quad PATH MEMBERS [URI]: a glTF file of a square across the view, 5 before the camera, with further members.
quad() {
  python3 - "$@" <<'PY'
import base64, json, struct, sys
path, members = sys.argv[1], json.loads(sys.argv[2])
data = struct.pack("<12f6H", -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 1, 2, 0, 2, 3)
uri = sys.argv[3] if len(sys.argv) > 3 else "data:application/octet-stream;base64," + base64.b64encode(data).decode()
doc = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(data), "uri": uri}],
       "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
       "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                     {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
       "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}}],
       "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
       "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.5}}],
       "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]}]}
def merge(to, what):
    for key, value in what.items():
        if isinstance(value, dict) and isinstance(to.get(key), dict):
            merge(to[key], value)
        else:
            to[key] = value
merge(doc, members)
json.dump(doc, open(path, "w"))
open("data.bin", "wb").write(data)
PY
}
small=(--size 32x24 --frames 1)

# Every command that reads scenes refuses a buffer outside the file's folder, and reads it when it is told to.
mkdir home
quad home/out.gltf '{}' ../data.bin
outside="home/out.gltf: buffer 0: '../data.bin' lies outside the file's folder; --allow-outside reads it"
trouble "$outside" "$kage" render home/out.gltf "${small[@]}" --out o
trouble "$outside" "$kage" cosim home/out.gltf "${small[@]}" --out o
trouble "$outside" "$kage" stream home/out.gltf "${small[@]}" --out o.kage
trouble "$outside" "$kage" explain home/out.gltf "${small[@]}" --pixel 16,12
trouble "$outside" "$kage" order home/out.gltf --eyes 2
trouble "$outside" "$kage" info home/out.gltf
[ ! -e o ] && [ ! -e o.kage ] || fail "a refused file leaves something"
expect 0 "$kage" render home/out.gltf "${small[@]}" --allow-outside --out o
expect 0 "$kage" stream home/out.gltf "${small[@]}" --allow-outside --out o.kage
expect 0 "$kage" explain home/out.gltf "${small[@]}" --allow-outside --pixel 16,12
expect 0 "$kage" order home/out.gltf --eyes 2 --allow-outside
expect 0 "$kage" info home/out.gltf --allow-outside
trouble "no-such-configuration" "$kage" cosim home/out.gltf "${small[@]}" --allow-outside --config no-such-configuration
printf 'mtllib ../m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >home/out.obj
echo 'newmtl m' >m.mtl
trouble "m.mtl' lies outside the file's folder; --allow-outside reads it" "$kage" render home/out.obj "${small[@]}" --out o
expect 0 "$kage" render home/out.obj "${small[@]}" --allow-outside --out o

# told TEXT FILE OPTION...: render says it, once.
told() {
  local text=$1
  shift
  expect 0 "$kage" render "$@" --frames 2 --out o
  [ "$(grep -cF -- "$text" stdout)" = 1 ] || { fail "render $* : does not say '$text' once"; cat stdout; }
}
# untold FILE OPTION...: render has nothing to say but how many frames there are, which configuration and that a light is added.
untold() {
  expect 0 "$kage" render "$@" --frames 1 --out o
  [ "$(grep -vc 'no light: \|: configuration: \|^1 frame' stdout)" = 0 ] || { fail "render $* : says more than it need"; cat stdout; }
}

quad plain.gltf '{}'
untold plain.gltf
quad required.gltf '{"extensionsUsed": ["FOO_bar"], "extensionsRequired": ["FOO_bar"]}'
trouble "required.gltf: extensionsRequired: the file cannot be drawn without FOO_bar, which kage does not know" \
  "$kage" render required.gltf "${small[@]}" --out none
[ ! -e none ] || fail "a refused render leaves a folder"
quad used.gltf '{"extensionsUsed": ["FOO_bar", "KHR_texture_transform"], "materials": [{"never": 1}]}'
told "used: 2 extensions are ignored: FOO_bar, KHR_texture_transform" used.gltf
told "used: 1 key is ignored, which kage does not know: materials/never" used.gltf

# A primitive that is ignored as a whole, of lines or without positions, has one note; none of its keys has another.
rest='"indices": 1, "material": 0, "never": {"at": [{"all": 1}]}, "targets": [{"POSITION": 0}]'
for primitive in '"attributes": {"POSITION": 0, "JOINTS_9": 0}, "mode": 1' '"attributes": {"NORMAL": 0, "JOINTS_9": 0}'; do
  quad part.gltf '{"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}, {'"$primitive, $rest"'}]}]}'
  told "part: 1 primitive " part.gltf
  ! grep -q 'does not know' stdout || fail "keys of an ignored primitive are named: $(cat stdout)"
done

# The camera: zfar, znear, its own shape.
lens() { quad "$1" '{"cameras": [{"type": "perspective", "perspective": '"$2"'}]}'; }
lens far.gltf '{"yfov": 0.7, "znear": 0.5, "zfar": 4}'
told "the camera's zfar is ignored: things beyond it are drawn" far.gltf
lens far.gltf '{"yfov": 0.7, "znear": 0.5, "zfar": 6}'
untold far.gltf
lens near.gltf '{"yfov": 0.7, "znear": 1e-6}'  # depth begins at what is seen
untold near.gltf
echo '{Z_BITS: 8}' >coarse.yaml
told "near: depth is coarse: with Z_BITS 8 surfaces 5 from the eye may be 0.00494 apart and have one depth, more than 1/10000 of the scene's extent of 2.83; Z_BITS 13 would do" near.gltf --config coarse.yaml
lens wide.gltf '{"yfov": 0.7, "znear": 0.5, "aspectRatio": 1.7778}'
told "1.78 times as wide as high, these 1.33" wide.gltf
untold wide.gltf --size 64x48   # a size that was asked for is meant
lens wide.gltf '{"yfov": 0.7, "znear": 0.5, "aspectRatio": 1.3333}'
untold wide.gltf

# Sides: from behind a single-sided face is drawn, with a note; --cull leaves it out; from the front neither does anything.
behind() { quad "$1" '{"materials": ['"$2"'], "nodes": [{"mesh": 0}, {"camera": 0, "rotation": [0, 1, 0, 0], "translation": [0, 0, -5]}]}'; }
behind single.gltf '{}'
told "the backs of single-sided faces are drawn: --cull leaves them out" single.gltf
expect 0 "$kage" render single.gltf "${small[@]}" --cull --json j.json --out o
json j.json 'any("nothing is to be seen" in n for n in j["notes"]) and not any("backs" in n for n in j["notes"])'
behind double.gltf '{"doubleSided": true, "pbrMetallicRoughness": {"metallicFactor": 0}}'
untold double.gltf
expect 0 "$kage" render double.gltf "${small[@]}" --cull --json j.json --out o
json j.json 'not any("nothing is to be seen" in n for n in j["notes"])'
expect 0 "$kage" render plain.gltf "${small[@]}" --cull --json j.json --out o
json j.json 'not any("nothing is to be seen" in n for n in j["notes"])'
expect 0 "$kage" stream plain.gltf "${small[@]}" --out plain.kage
trouble "--cull" "$kage" render plain.kage --cull --out o

# --sub-bits: fewer bits move edges, for the RTL as for the golden core; all of them are the default.
for bits in 4 8; do
  expect 0 "$kage" stream edges "${small[@]}" --sub-bits $bits --out bits$bits.kage
done
expect 0 "$kage" stream edges "${small[@]}" --out bits.kage
cmp -s bits.kage bits8.kage || fail "8 bits of a subpixel are not the default"
cmp -s bits.kage bits4.kage && fail "4 bits of a subpixel move no edge"

# --max-shading: 2 is the default, 0 cuts nothing, and less error takes more words.
for most in 0 1 2; do
  expect 0 "$kage" stream inside "${small[@]}" --max-shading $most --out shading$most.kage
done
expect 0 "$kage" stream inside "${small[@]}" --out shading.kage
cmp -s shading.kage shading2.kage || fail "2 is not the default of --max-shading"
size() { stat -c %s "shading$1.kage"; }
[ "$(size 0)" -lt "$(size 2)" ] && [ "$(size 2)" -lt "$(size 1)" ] || fail "--max-shading: $(size 0), $(size 2) and $(size 1) bytes"

# An unlit square shows its colour: sRGB of 0.5 and 0.25.
quad unlit.gltf '{"materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]}, "extensions": {"KHR_materials_unlit": {}}}]}'
quad lamp.gltf '{"materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [0.5, 0.25, 1]}]}'
for file in unlit lamp; do
  for config in default full soft lights; do
    expect 0 "$kage" explain $file.gltf "${small[@]}" --config $config --pixel 16,12 --json j.json
    json j.json 'j["color"]==[188, 137, 255]'
  done
done

# kage info of a scene.
expect 0 "$kage" info courtyard --json j.json
json j.json 'j["triangles"]>100 and j["components"]["closed"]==j["components"]["all"]==j["components"]["convex"] and j["cameras"]==1 and j["lights"]==["directional"]'
json j.json 'j["configuration"]=="meshes" and "full" in j["configurations"] and "tiny" in j["lacks"] and j["materials"]["translucent"]==0 and j["notes"]==[]'
expect 0 "$kage" info used.gltf --json j.json
json j.json 'j["triangles"]==2 and j["objects"]==1 and j["components"]["closed"]==0 and "one face only" in j["components"]["first_not_closed"]["why"]'
json j.json 'j["lights"]==[] and j["materials"]=={"all": 1, "translucent": 0, "unlit": 0, "single_sided": 1} and j["animations"]==0'
json j.json 'any("FOO_bar" in n for n in j["notes"])'
expect 0 "$kage" info single.gltf
grep -q 'note: the backs of single-sided faces are drawn' stdout || fail "info does not tell what render tells"
# The configuration that info names is the one that render takes.
for scene in glass penumbra three-lights polyhedra; do
  expect 0 "$kage" info $scene --size 64x48 --json i.json
  expect 0 "$kage" render $scene --size 64x48 --frames 1 --json r.json --out o
  python3 -c "import json; i=json.load(open('i.json')); r=json.load(open('r.json')); raise SystemExit('$scene: configuration: '+i['configuration'] not in ['$scene: '+n for n in r['notes']])" ||
    fail "info and render of $scene name different configurations"
done
expect 0 "$kage" info courtyard --size 4096x48 --json j.json
json j.json 'j["configurations"]==["widest"] and j["configuration"]=="widest" and j["widened"] is None'
list_without_widest narrower
KAGE_DATA_DIR=$PWD/narrower expect 0 "$kage" info courtyard --size 4096x48 --json j.json
json j.json 'j["configurations"]==[] and j["configuration"] is None and "MAX_WIDTH: 4096" in j["widened"]'
KAGE_DATA_DIR=$PWD/narrower expect 0 "$kage" info courtyard --size 4096x48
grep -q 'none; --config FILE can' stdout || fail "info does not say how a wide picture can be drawn"
trouble "--tokens: only a stream file has tokens" "$kage" info courtyard --tokens 0
trouble "--size: a stream has its own size" "$kage" info plain.kage --size 32x24
trouble "no such file" "$kage" info none.gltf
expect 0 "$kage" info plain.kage
grep -q 'checksums right' stdout || fail "info of a stream says something else"
# ---- no output overwrites what is read ----
over="this output would overwrite an input"
mkdir over
quad over/quad.gltf '{"images": [{"uri": "paint%20.png"}]}' quad.bin
cp data.bin over/quad.bin
echo picture >"over/paint .png"
printf 'mtllib quad.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >over/quad.obj
printf 'newmtl m\nKd 1 0 0\n' >over/quad.mtl
echo 'Z_BITS: 24' >over/core.yaml
expect 0 "$kage" vectors courtyard --size 8x6 --frames 1 --sound-only --config default --no-rtl --out over/pack
sums() { (cd over && find . -type f -exec sha256sum {} + | sort); }
sums >before
for to in --json --csv --store; do
  trouble "over/quad.obj: $over" "$kage" sweep over/quad.obj "${small[@]}" $to ./over/quad.obj
  trouble "over/core.yaml: $over" "$kage" sweep courtyard "${small[@]}" --config over/core.yaml $to ./over/core.yaml
  trouble "over/quad.mtl: $over" "$kage" sweep over/quad.obj "${small[@]}" --resume $to over/quad.mtl
done
for of in quad.obj quad.mtl; do
  trouble "over/$of: $over" "$kage" plan over/quad.obj --json over/$of
  trouble "over/$of: $over" "$kage" model --plan over/quad.obj --json over/$of
  for to in json save plot; do trouble "over/$of: $over" "$kage" order over/quad.obj --$to over/$of; done
done
for of in quad.gltf quad.bin "paint .png"; do
  for command in info render "explain --pixel 1,1" "stream --out new.kage" "vectors --sizes"; do
    # shellcheck disable=SC2086
    trouble "over/$of: $over" "$kage" $command over/quad.gltf --json "over/$of"
  done
  for to in json junit; do trouble "over/$of: $over" "$kage" cosim over/quad.gltf "${small[@]}" --$to "over/$of"; done
  trouble "over/$of: $over" "$kage" stream over/quad.gltf --out "over/$of"
done
for of in over/pack/*; do
  trouble "$of: $over" "$kage" vectors --check over/pack --json "$of"
  trouble "$of: $over" "$kage" vectors --compare over/pack over/pack/pixels.hex --json "$of"
done
cp over/pack/pixels.hex got
trouble "got: $over" "$kage" vectors --compare over/pack got --json ./got
# Pictures and evidence have names that the scene's decides.
cp over/quad.bin over/quad_0000.png
quad over/quad.gltf '{}' quad_0000.png
cp over/quad_0000.png over/quad_0001.png
printf 'newmtl m\nKd 1 0 0\nmap_Kd -s 2 2 2 quad_0001.png\n' >over/quad.mtl
sums >before
trouble "over/quad_0000.png: $over" "$kage" render over/quad.gltf "${small[@]}" --out over
trouble "over/quad_0001.png: $over" "$kage" render over/quad.obj --size 32x24 --frames 2 --out over
mv over/quad_0000.png over/quad_0000_difference.png
quad over/quad.gltf '{"images": [{"uri": "quad_0000_difference.png"}]}' quad.bin
sums >before
expect 0 "$kage" cosim over/quad.gltf --config tiny --degrade --size 16x12 --frames 1 --no-report --out over
rm over/quad_0000.png  # of the run
sums | diff - before || fail "an input was overwritten"

# ---- no name begins a line, which may be a command to whoever reads the output ----
evil=$'a\n::error::b\x1b[31m'
# clean RC COMMAND...: it prints, and no line of it begins with what a name says.
clean() {
  expect "$@"
  [ -s stdout ] || fail "${*:2}: prints nothing"
  ! grep -qE $'^::error::|\x1b|\x7f' stdout || fail "${*:2}: $(grep -aE $'^::error::|\x1b' stdout | cat -v)"
}
mkdir evil
quad evil/named.gltf '{"nodes": [{"mesh": 0, "name": "a\\n::error::b\\u001b[31m"}, {"camera": 0, "translation": [0, 0, 5]}]}'
cp evil/named.gltf "evil/$evil.gltf"
clean 0 "$kage" info evil/named.gltf
clean 0 "$kage" info "evil/$evil.gltf"
clean 0 "$kage" render evil/named.gltf "${small[@]}" --out "evil/$evil"
clean 0 "$kage" plan "evil/$evil.gltf" "${small[@]}"
clean 0 "$kage" order "evil/$evil.gltf"
clean 0 "$kage" stream evil/named.gltf "${small[@]}" --config polyhedra --out "evil/$evil.kage"
clean 0 "$kage" info "evil/$evil.kage"
cp -r over/pack evil/pack
python3 - evil/pack/manifest.json <<'PY'
import json, sys
m = json.load(open(sys.argv[1]))
m["config_name"] = "a\n::error::b\x1b[31m\0"
json.dump(m, open(sys.argv[1], "w"))
PY
clean 0 "$kage" vectors --check evil/pack
mkdir evil/a evil/b
for f in evil/a/same evil/b/same "evil/a/$evil" "evil/a/c$evil" "evil/b/d$evil" "evil/b/c$evil"; do cp "evil/$evil/named_0000.png" "$f.png"; done
expect 0 "$kage" render courtyard "${small[@]}" --out evil/other
cp evil/other/courtyard_0000.png "evil/b/c$evil.png"
echo text | tee "evil/a/$evil.text" >"evil/b/$evil.text"
clean 1 "$kage" diff evil/a evil/b
cp -r evil/b "evil/$evil.b"
clean 1 "$kage" diff evil/a "evil/$evil.b"
clean 1 "$kage" diff evil/a evil/b --bless --dry-run

done_testing
