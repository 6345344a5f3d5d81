#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# JSON and YAML that nest as deeply as a file can hold, in every place from which kage reads them. The answer is one line that
# names file and place, exit code 2, and nothing written. unit/json/foreign_json has the parser's limits.
. "$(dirname "$0")/common.bash"

python3 - <<'PY'
import pathlib
for name, levels in (("limit", 129), ("deep", 100_000), ("deeper", 3_000_000)):
    nested = "[" * levels + "]" * levels
    # As the first key of an object that then grows, which copies it level by level.
    text = f'{{"x": {nested}, ' + ", ".join(f'"k{i}": {i}' for i in range(40)) + ', "schema": "kage.cosim/1"}'
    pathlib.Path(f"{name}.json").write_text(text)
    pathlib.Path(f"open_{name}.json").write_text('{"x": ' + "[" * levels)
    pathlib.Path(f"{name}.gltf").write_text(text.replace('"schema"', '"asset": {"version": "2.0"}, "schema"'))
    folder = pathlib.Path(f"pack_{name}")
    folder.mkdir()
    (folder / "manifest.json").write_text(text.replace("kage.cosim", "kage.pack"))
pathlib.Path("list.yaml").write_text("[" * 100_000)
pathlib.Path("map.yaml").write_text("{a: " * 50_000)
pathlib.Path("lines.yaml").write_text("- " * 100_000 + "1\n")
pathlib.Path("long.yaml").write_text("#" * 300_000 + "\nLANES: 4\n")
PY
echo '{"schema": "kage.cosim/1"}' >shallow.json
nests='arrays and objects nest more than 128 deep'
for name in limit deep deeper open_limit open_deep; do
  trouble "$name.json: line 1, column" "$kage" merge $name.json shallow.json
  grep -qF "$nests" stderr || fail "merge $name.json: $(cat stderr)"
done
for name in limit deep deeper; do
  trouble "pack_$name/manifest.json: line 1, column 134: $nests" "$kage" vectors --check pack_$name
  trouble "pack_$name/manifest.json: line 1, column 134: $nests" "$kage" vectors --compare pack_$name shallow.json
  trouble "pack_$name/manifest.json: line 1, column 134: $nests" "$kage" board --port sim:ulx3s_25f pack_$name
  for command in render info cosim; do
    trouble "$name.gltf: line 1, column 134: $nests" "$kage" $command $name.gltf
  done
done
for name in list map lines; do trouble "$name.yaml: line 1: lists nest too deeply" "$kage" render courtyard --config $name.yaml; done
trouble 'long.yaml: more than 262144 bytes' "$kage" render courtyard --config long.yaml

# A stream file's section ORIG.
expect 0 "$kage" stream polyhedra --config polyhedra --size 32x24 --frames 1 --out sound.kage
python3 - <<'PY'
import pathlib, struct, zlib
sound, at, sections = pathlib.Path("sound.kage").read_bytes(), 8, []
while at < len(sound):
    (size,) = struct.unpack_from("<Q", sound, at + 8)
    sections.append((sound[at : at + 4], sound[at + 16 : at + 16 + size]))
    at += 16 + (size + 7) // 8 * 8
assert [tag for tag, _ in sections] == [b"CONF", b"FRAM", b"ORIG", b"DONE"], sections
for name, origin in (("limit", None), ("deep", None), ("broken", b'{"scene": '), ("number", b'[1e999]'), ("sound", sections[2][1])):
    if origin is None:
        origin = pathlib.Path(f"{name}.json").read_bytes()
    data, sums = sound[:8], 0
    for tag, body in sections:
        if tag == b"ORIG":
            body = origin
        if tag == b"DONE":
            body = struct.pack("<QI", 1, sums)
        head = tag + struct.pack("<IQ", zlib.crc32(body), len(body))
        sums = zlib.crc32(head, sums)
        data += head + body + b"\0" * (-len(body) % 8)
    pathlib.Path(f"{name}.kage").write_bytes(data)
assert pathlib.Path("sound.kage").read_bytes() == sound
PY
for command in info "stream --out none.kage" "cosim --out none" "render --out none" "explain --pixel 1,1"; do
  # shellcheck disable=SC2086
  set -- $command
  trouble "limit.kage: section ORIG: line 1, column 134: $nests" "$kage" "$1" limit.kage "${@:2}"
  trouble "deep.kage: section ORIG: line 1, column 134: $nests" "$kage" "$1" deep.kage "${@:2}"
  trouble 'broken.kage: section ORIG: line 1, column 11: not JSON, or cut off' "$kage" "$1" broken.kage "${@:2}"
  trouble 'number.kage: section ORIG: not JSON: it has a number that no double holds' "$kage" "$1" number.kage "${@:2}"
done
[ ! -e none ] && [ ! -e none.kage ] || fail "something was written"

# The cache's report on a model.
mkdir -p cache/kage/models
chmod 700 cache cache/kage cache/kage/models
for name in deep limit; do
  (umask 077 && cp $name.json cache/kage/models/$name.json && echo none >cache/kage/models/$name.so)
done
XDG_CACHE_HOME=$PWD/cache expect 0 "$kage" cache list
no_leftovers
done_testing
