#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The cache of RTL models: a damaged model is built anew, one that somebody else could have changed is not loaded, and
# `kage cache` shows, verifies and prunes.
. "$(dirname "$0")/common.bash"

echo '{MAX_WIDTH: 64, LANES: 2, BEAT_WORDS: 1}' >small.yaml
expect 0 "$kage" stream courtyard --size 64x48 --frames 1 --config small.yaml --out s.kage
export XDG_CACHE_HOME=$PWD/cache
models=$PWD/cache/kage/models
cosim() { expect "$1" "$kage" cosim s.kage --no-report --out out; }

# An empty cache, made by nobody yet.
expect 0 "$kage" cache --json c.json
json c.json "j['folder'] == '$models' and j['models'] == [] and j['bytes'] == 0"
[ "$(stat -c %a cache/kage cache/kage/models | sort -u)" = 700 ] || fail "others may look into a new cache"

umask 000 # as careless as can be: what kage makes is still nobody else's to write to
expect 0 env XDG_CACHE_HOME="$PWD/made/by/kage" "$kage" cache
[ -z "$(find made -perm /022)" ] || fail "others may write to: $(find made -perm /022)"
# A home of any name, in which the one model of this test is built: make, the shell, a linker's options and paths in lists have
# such characters for themselves.
umask 022
home="$PWD/my \"home\" of 'kage', 100%:\$HOME #1;&(\`)"
mkdir "$home"
umask 000
expect 0 env -u XDG_CACHE_HOME HOME="$home" "$kage" cosim s.kage --no-report --out out
umask 022
rm -r cache && mv "$home/.cache" cache
model=$(echo "$models"/*.so) manifest=${model%.so}.json
[ -f "$model" ] && [ -f "$manifest" ] || fail "no model with its manifest: $(ls "$models")"
[ -z "$(find cache -type f -perm /022)" ] || fail "others may write to: $(find cache -type f -perm /022)"
cosim 0
[ ! -s "$temp/stderr" ] || fail "a whole model and yet: $(cat "$temp/stderr")"

# Damage of every kind is seen; what is damaged is told in a line, built anew, and whole again.
cp -a "$models" whole
verify() { # TEXT: what is damaged, and how; then all is whole again
  expect 1 "$kage" cache verify
  grep -qF "damaged: $1" "$temp/stdout" || fail "verify does not say '$1': $(cat "$temp/stdout")"
  cp -a whole/. "$models/"
}
truncate -s 1000 "$model" && verify "it has 1000 bytes in place of $(stat -c %s "whole/$(basename "$model")")"
: >"$model" && verify "it has 0 bytes"
printf 'junk' | dd of="$model" bs=1 seek=70000 conv=notrunc status=none && verify "its checksum differs"
rm "$manifest" && verify "it has no checksum"
echo '{"bytes": "many"' >"$manifest" && verify "it has no checksum"
echo '{"bytes": "many", "crc32": -1}' >"$manifest" && verify "it has no checksum"
expect 0 "$kage" cache verify

truncate -s 1000 "$model"
find cache/kage/verilator -name '*.o' -exec truncate -s 100 {} + # objects that each model is linked with
cosim 0
grep -q "^kage: the RTL model of configuration .* was damaged (it has 1000 bytes .*) and has been built anew: $models" "$temp/stderr" || fail "$(cat "$temp/stderr")"
[ "$(wc -l <"$temp/stderr")" = 1 ] || fail "more than a line: $(cat "$temp/stderr")"
expect 0 "$kage" cache verify

# Nobody else's files: modes, links, owners. A link in place of the log is not followed.
untrusted() { # TEXT: what is refused, and by which words
  trouble "$1" "$kage" cosim s.kage --no-report --out out
}
chmod 777 "$models" && untrusted "others may write to it (mode 0777)"
grep -q "chmod -R go-w $models" "$temp/stderr" || fail "no way to mend it: $(cat "$temp/stderr")"
chmod 700 "$models"
chmod 770 cache/kage && untrusted "cache/kage: others may write to it (mode 0770)"
chmod 700 cache/kage
chmod 602 "$model" && untrusted "$model: others may write to it (mode 0602)"
chmod 600 "$model"
chmod 777 cache && untrusted "cache: others may write to it (mode 0777)"
chmod 755 cache
mv "$model" real.so && ln -s "$PWD/real.so" "$model" && untrusted "$model: cannot be read: it is a link"
rm "$model" && mv real.so "$model"
mkfifo "$model.fifo" && mv "$model" kept.so && mv "$model.fifo" "$model" && untrusted "$model: is no file"
rm "$model"
echo precious >precious
ln -sf "$PWD/precious" "${model%.so}.log"
mkdir tools && printf '#!/bin/sh\nexit 1\n' >tools/make && chmod +x tools/make
expect 2 env PATH="$PWD/tools:$PATH" "$kage" cosim s.kage --no-report --out out # its log would replace the link
grep -q 'RTL model: the build failed' "$temp/stderr" || fail "$(cat "$temp/stderr")"
[ "$(cat precious)" = precious ] || fail "a link was followed"
rm "${model%.so}.log" && mv kept.so "$model"
chmod 777 cache/kage/verilator && untrusted "cache/kage/verilator: others may write to it"
chmod 700 cache/kage/verilator
# A link to a folder of one's own elsewhere serves as well, unless somebody else could put another folder there.
mkdir disk && mv cache/kage disk/kage && ln -s "$PWD/disk/kage" cache/kage
truncate -s 1000 "$model"
cosim 0
expect 0 "$kage" cache verify
chmod 777 disk && untrusted "disk: others may write to it (mode 0777)"
rm cache/kage && mv disk/kage cache/kage
if [ "$(id -u)" = 0 ]; then
  chown 12345 "$models" && untrusted "belongs to user 12345, you are user 0"
  chown 0 "$models"
  chown 12345 "$model" && untrusted "$model: belongs to user 12345"
  chown 0 "$model"
fi
cosim 0

# Tools that are there and do not run, and a disk on which nothing may be run, are told as that.
tools_of() { XDG_CACHE_HOME="$PWD/new" "$@" "$kage" model small.yaml; }
# shellcheck disable=SC2016 # the variable's name
VERILATOR_ROOT=/nonexistent trouble '$VERILATOR_ROOT is /nonexistent, and no Verilator is there: unset it' tools_of env
printf '#!/bin/sh\necho "it lacks its library" >&2\nexit 1\n' >tools/verilator && chmod +x tools/verilator
trouble 'verilator: it is there and does not run: it lacks its library' tools_of env PATH="$PWD/tools:$PATH"
chmod -x tools/verilator
trouble 'verilator: it is there and does not run: Permission denied' tools_of env VERILATOR="$PWD/tools/verilator"
trouble 'verilator: not found, and RTL models need it' tools_of env VERILATOR=none-such
mkdir -p noexec
if unshare -m mount -t tmpfs -o noexec none noexec 2>/dev/null; then
  # shellcheck disable=SC2016 # of the inner shell
  trouble "noexec/kage/models: on its file system nothing may be run (noexec)" unshare -m sh -c \
    'mount -t tmpfs -o noexec,mode=700 none noexec && XDG_CACHE_HOME="$PWD/noexec" exec "$@"' sh "$kage" model small.yaml
else
  echo "SKIPPED: no file system can be mounted here, so a cache on one that runs no programs is not tried"
fi

# List and prune.
expect 0 "$kage" cache list
grep -q "MAX_WIDTH=64" "$temp/stdout" || fail "the list does not tell the parameters: $(cat "$temp/stdout")"
expect 0 "$kage" cache prune --older-than 1h --max-size 1G
grep -q "removed 0 models" "$temp/stdout" || fail "a young small model is gone: $(cat "$temp/stdout")"
touch -d '2 days ago' "$model"
expect 0 "$kage" cache prune --older-than 3d
expect 0 "$kage" cache prune --older-than 120000d # more nanoseconds than 64 bits hold
[ -f "$model" ] || fail "it is two days old, and models of three days were to go"
expect 0 "$kage" cache prune --older-than 1d --json p.json
json p.json "len(j['models']) == 1 and j['left'] == {'models': 0, 'bytes': 0}"
[ -z "$(find "$models" -type f)" ] || fail "prune left: $(find "$models" -type f)"
# Files that belong to no model are counted and go too.
echo "a build that failed" >"$models/gone.log" && : >"$models/gone.lock" && touch -d '400 days ago' "$models"/gone.*
touch -d '400 days ago' cache/kage/verilator/*/*
expect 0 "$kage" cache --json c.json
json c.json "j['other_bytes'] > 100000"
expect 0 "$kage" cache prune --older-than 500d
[ -f "$models/gone.log" ] || fail "a log of 400 days is gone, and older ones were to go"
expect 0 "$kage" cache prune --older-than 300d --json p.json
json p.json "j['other_bytes'] == 0"
[ -z "$(find "$models" cache/kage/verilator -mindepth 1)" ] || fail "prune left: $(find "$models" cache/kage/verilator)"
cp -a whole/. "$models/"
expect 0 "$kage" cache prune --max-size 1K
[ -z "$(find "$models" -name '*.so')" ] || fail "a model larger than a kibibyte is there"
for wrong in "list --max-size 1G" "prune --max-size 1" "prune --older-than 3" "prune --older-than 99999999999999999999d" "forget"; do
  # shellcheck disable=SC2086
  trouble "" "$kage" cache $wrong
done
done_testing
