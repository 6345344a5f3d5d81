#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Help, version, and a command line that makes no sense.
. "$(dirname "$0")/common.bash"

expect 0 "$kage" --help
[ "$(wc -L <stdout)" -le 110 ] || fail "--help has long lines"
expect 0 "$kage" --version
for command in cosim board render stream info explain diff merge model order; do
  expect 0 "$kage" $command --help
  grep -q Examples: stdout || fail "$command --help has no examples"
  [ "$(wc -L <stdout)" -le 110 ] || fail "$command --help has long lines"
done

# The last of an option given twice counts.
expect 0 "$kage" stream courtyard --size 640x480 --size 32x24 --frames 2 --frames 1 --out twice.kage
expect 0 "$kage" info twice.kage --json twice.json
json twice.json 'j["frames"]==1 and j["lines"]==24'

# line TEXT COMMAND...: exactly that line, so nothing of the parser's own words and lists.
line() {
  trouble "$@"
  [ "$(cat stderr)" = "$1" ] || fail "${*:2}: says '$(cat stderr)'"
}
line "kage: no command given; see kage --help" "$kage"
line "kage: nonsense: no such command; see kage --help" "$kage" nonsense
line "kage: rendr: no such command (did you mean render?); see kage --help" "$kage" rendr courtyard --out none
line "kage: cosmi: no such command (did you mean cosim?); see kage --help" "$kage" cosmi
# The same of scenes, configurations, parameters and faults.
trouble "courtyrad: no such file, and no built-in scene of that name (did you mean courtyard?) (there are " "$kage" info courtyrad
trouble "glas: no such file, and no configuration of that name (did you mean glass?) (there are " "$kage" render courtyard --config glas --out none
echo '{LANE: 2}' >lane.yaml
trouble "lane.yaml: line 1: LANE: no such parameter (did you mean LANES?)" "$kage" render courtyard --config lane.yaml --out none
trouble "wrong_compar: no such fault (did you mean wrong_compare?) (there are " "$kage" cosim courtyard --fault wrong_compar --out none
line "kage: --verson: no such option (did you mean --version?); see kage --help" "$kage" --verson
line "kage: --sise: no such option (did you mean --size?); see kage render --help" "$kage" render courtyard --sise 3x3
line "kage: --conf=x: no such option (did you mean --config?); see kage cosim --help" "$kage" cosim courtyard --conf=x
line "kage: --frobnicate: no such option; see kage info --help" "$kage" info x --frobnicate
# A variable that a script forgot to set.
line "kage: SCENE: its value is empty; see kage render --help" "$kage" render ""
line "kage: --out: its value is empty; see kage render --help" "$kage" render courtyard --out ""
line "kage: --json: its value is missing; see kage cosim --help" "$kage" cosim courtyard --json=
line "kage: CONFIG: its value is empty; see kage model --help" "$kage" model ""
line "kage: --size requires --plan; see kage model --help" "$kage" model default --size 64x48
# Standard output is a file for --json, for --csv and for a stream alone.
line "kage: --junit: - is no file's name here, ./- is one; see kage cosim --help" "$kage" cosim courtyard --junit -
line "kage: --out: - is no file's name here, ./- is one; see kage render --help" "$kage" render courtyard --out -
line "kage: --plot: - is no file's name here, ./- is one; see kage order --help" "$kage" order courtyard --plot -
line "kage: --store: - is no file's name here, ./- is one; see kage sweep --help" "$kage" sweep courtyard --store -
line "kage: --config: - is no file's name here, ./- is one; see kage info --help" "$kage" info courtyard --config -
line "kage: --csv - and --json -: both are standard output" "$kage" sweep courtyard --csv - --json -
[ ! -e - ] || fail "a file is called -"
line "kage: --size: options come after the command; see kage render --help" "$kage" --size 3x3 render courtyard
# ---- a thing of another command, or in another's place ----
printf 'LANES: 4\n' >four.yaml
line "kage: --config: no option of kage model: a configuration is an argument; see kage model --help" "$kage" model --config default
line "kage: --front-end: no option of kage stream: --level polygons makes the stream that a front end takes; see kage stream --help" "$kage" stream courtyard --front-end rtl
line "kage: --ot: no such option (did you mean --out?); see kage stream --help" "$kage" stream courtyard --ot x
line "kage: four.yaml: a configuration, and no scene: --config takes it" "$kage" cosim four.yaml
cp "$source/scenes/knot.gltf" .
mkdir pictures
line "kage: knot.gltf: is a scene; kage render makes pictures of it" "$kage" diff pictures knot.gltf
line "kage: knot.gltf: is a scene; kage render makes pictures of it" "$kage" diff knot.gltf knot.gltf
line "kage: four.yaml: is a file, and pictures is a directory: there is nothing to compare" "$kage" diff pictures four.yaml
line "kage: four.yaml: no format of pictures that is read" "$kage" diff four.yaml four.yaml
# ---- text that is not YAML, in kage's words ----
no_yaml() { # TEXT LINE_AND_WORDS
  printf '%b' "$1" >bad.yaml
  line "kage: bad.yaml: $2" "$kage" model bad.yaml
}
no_yaml 'LANES: [1, 2\nX_BITS: 3\n' 'line 2: a [ has no ]'
no_yaml 'LANES: {a: 2\nX_BITS: 3\n' 'line 2: a { has no }'
no_yaml 'LANES: 4\n---\nLANES: 8\n' 'line 2: a second document begins, and a configuration is one'
no_yaml '# mine\n---\nLANES: 4\n...\ngarbage\n' 'line 4: a second document begins, and a configuration is one'
no_yaml 'LANES: 4: 5\n' 'line 1: not YAML: a line is PARAMETER: value'
no_yaml 'LANES: *x\n' 'line 1: * wants the name of an anchor, and there is none of this name'
no_yaml 'LANES: "4\n' 'line 1: LANES: not a whole number'
no_yaml 'Z_BITS: 24\nLANES: 5\n' 'line 2: LANES is 5, legal are 1, 2, 4, 8, 16, 32'
line "kage: b: an argument too many; see kage render --help" "$kage" render courtyard b c
line "kage: --frames: its value is missing; see kage render --help" "$kage" render courtyard --frames
line "kage: A is missing; see kage diff --help" "$kage" diff
line "kage: --seed: -1 is not a whole number from 0 to 2^64 - 1; see kage cosim --help" "$kage" cosim courtyard --seed -1
trouble 18446744073709551616 "$kage" cosim courtyard --seed 18446744073709551616
trouble "--lsb" "$kage" diff a b --lsb many
trouble "(did you mean scenes?)" "$kage" list scen
trouble "(did you mean exact?)" "$kage" render courtyard --order exakt
trouble "(did you mean ice40?)" "$kage" model default --netlist ice4
trouble "(did you mean polygons?)" "$kage" stream courtyard --level polygon
trouble "--size" "$kage" render courtyard --size 640
trouble "--size" "$kage" render courtyard --size 0x480
trouble "--size" "$kage" render courtyard --size 640x480x3
trouble "--size" "$kage" render courtyard --size -1x480
trouble "--frames" "$kage" render courtyard --frames 0
trouble "--threads" "$kage" render courtyard --threads 0
trouble "--netlist" "$kage" cosim courtyard --netlist xilinx
mkdir pack && echo '{}' >pack/manifest.json
for command in cosim vectors; do
  trouble "pack: a folder of kage vectors is no scene: kage board plays it, kage vectors --check reads it" "$kage" $command pack
done
trouble "' ': no such file" "$kage" render ' ' --out none
trouble "not with --netlist" "$kage" cosim courtyard --netlist ice40 --mutant 3 --size 32x24 --frames 1
YOSYS=/nowhere trouble "\$YOSYS: \`/nowhere -V\` fails" "$kage" model tiny --netlist ice40
YOSYS=/bin/false trouble "\$YOSYS: \`/bin/false -V\` fails" "$kage" model tiny --netlist ice40
YOSYS="false -x" trouble "\$YOSYS: \`false -x -V\` fails" "$kage" model tiny --netlist ice40
mkdir broken_yosys && ln -s /bin/false broken_yosys/yosys
YOSYS='' PATH=$PWD/broken_yosys:$PATH trouble "yosys: not found, or \`yosys -V\` fails" "$kage" model tiny --netlist ice40
line "kage: --mutant: 0 is not a whole number from 1 to 100000; see kage cosim --help" "$kage" cosim courtyard --mutant 0
line "kage: --frames: 1000001 is not a whole number from 1 to 1000000; see kage render --help" "$kage" render courtyard --frames 1000001
# CLI11 alone would take these for 8, 16 and no number at all, which is within any limits.
line "kage: --frames: 010 begins with 0; see kage render --help" "$kage" render courtyard --frames 010
line "kage: --samples: 0x10 is not a whole number from 1 to 255; see kage render --help" "$kage" render penumbra --samples 0x10
line "kage: --sub-bits: 3 is not a whole number from 4 to 8; see kage render --help" "$kage" render courtyard --sub-bits 3
line "kage: --max-shading: 256 is not a whole number from 0 to 255; see kage render --help" "$kage" render courtyard --max-shading 256
line "kage: --sub-bits: 9 is not a whole number from 4 to 8; see kage render --help" "$kage" render courtyard --sub-bits 9
line "kage: --alpha: 0 is not in 1/255 .. 1; see kage render --help" "$kage" render courtyard --alpha 0
expect 0 "$kage" stream courtyard --alpha 0.00392156862745098 --size 32x24 --frames 1 --out faint.kage
line "kage: --alpha: nan is not a number; see kage render --help" "$kage" render courtyard --alpha nan
trouble "--out" "$kage" stream courtyard
trouble "no such file" "$kage" model nowhere.yaml
printf 'Z_BITS: 40\n' >wide.yaml
trouble "wide.yaml" "$kage" model wide.yaml
printf 'Z_BITS: [\n' >broken.yaml
trouble "broken.yaml" "$kage" model broken.yaml
printf 'DEPTH: 4\n' >unknown.yaml
trouble "DEPTH" "$kage" model unknown.yaml
line "kage: unknown.yaml: line 1: DEPTH: no such parameter" "$kage" model unknown.yaml
printf 'mine:\n  LANES: 4\n' >named.yaml
line "kage: named.yaml: line 1: mine: no such parameter; a file has the parameters of one configuration, with no name over them" "$kage" model named.yaml
line "kage: courtyard: configuration systolic64 lacks MAX_WIDTH >= 640; --size up to 64 wide fits" \
  "$kage" render courtyard --config systolic64 --out none
expect 0 "$kage" render courtyard --config systolic64 --size 64x48 --frames 1 --out fits
expect 2 "$kage" render glass --config systolic64 --size 64x48 --out none
! grep -q 'wide fits' stderr || fail "a size is offered though none would do: $(cat stderr)"

# A message for a person lands in no file of results, and nobody to hear it is no reason to fall over.
expect 0 "$kage" stream courtyard --size 64x48 --frames 3 --out heard.kage
for closed in '2>&-' '0<&- 1>&- 2>&-' '2>/dev/full'; do
  rc=0
  (eval "KAGE_PROGRESS=0.0000001 \"\$kage\" stream courtyard --size 64x48 --frames 3 --out unheard.kage >/dev/null $closed") || rc=$?
  cmp -s heard.kage unheard.kage || fail "stream $closed: another file"
  [[ $rc == 0 || $closed == *'1>&-'* ]] || fail "stream $closed: exit $rc"
  rc=0
  (eval "\"\$kage\" info nothing.kage >/dev/null $closed") || rc=$?
  [ $rc = 2 ] || fail "info $closed: exit $rc of a file that is not there"
done
# Output that does not arrive is trouble; a reader who has had enough knows.
for command in "info heard.kage" "info heard.kage --json -" "cosim heard.kage --no-report --out full" "diff heard.kage heard.kage" \
  --version --help "help cosim" "help --man" list "render heard.kage --out full" "info heard.kage --tokens 0"; do
  rc=0
  # shellcheck disable=SC2086
  "$kage" $command >/dev/full 2>stderr || rc=$?
  [ $rc = 2 ] && grep -q '^kage: standard output: cannot be written: No space left on device$' stderr || fail "$command >/dev/full: exit $rc, $(cat stderr)"
done
# A run that cannot say its result leaves what was there before.
mkdir kept && echo old >kept/heard_0000.png && cp kept/heard_0000.png kept/s.kage && cp kept/heard_0000.png kept/t.bsp
for command in "render heard.kage --out kept" "stream courtyard --size 32x24 --frames 1 --out kept/s.kage" \
  "order $source/verif/test/meshes/sixteen_faces.obj --eyes 2 --repeats 1 --save kept/t.bsp"; do
  # shellcheck disable=SC2086
  trouble "standard output: cannot be written" sh -c 'exec "$@" >/dev/full' sh "$kage" $command
done
[ "$(cat kept/*)" = "$(printf 'old\nold\nold')" ] || fail "a run that failed left: $(ls -l kept)"
# Standard output that is closed is trouble for whoever has something to say there, and standard error that is closed is not.
for command in "stream heard.kage --out -" "info heard.kage" "info heard.kage --json -" "list" "diff heard.kage heard.kage"; do
  # shellcheck disable=SC2086
  trouble "standard output: cannot be written" sh -c 'exec "$@" >&-' sh "$kage" $command
done
# A name that begins a line on a page of CI is refused.
printf 'LANES: 4\n' >$'line\n::warning::x'
trouble "a configuration's name holds no control characters" "$kage" render courtyard --config $'line\n::warning::x' --out none
# A link to a file that is not there yet is written through.
mkdir elsewhere && ln -s elsewhere/l.kage link.kage
expect 0 "$kage" stream courtyard --size 32x24 --frames 1 --out link.kage
[ -L link.kage ] && [ -s elsewhere/l.kage ] || fail "--out on a link: $(ls -l link.kage elsewhere)"
# More threads than processors are no matter to anybody who reads standard error.
for command in "order $source/verif/test/meshes/sixteen_faces.obj --eyes 2 --repeats 1" \
  "stream glass --size 64x48 --frames 1 --out glass.kage" "render glass --size 64x48 --frames 1 --out glass"; do
  # shellcheck disable=SC2086
  expect 0 "$kage" $command --threads 9
  [ ! -s stderr ] || fail "$command --threads 9: $(cat stderr)"
done
# So few open files that something cannot be opened: that is what is told.
echo '{"asset":{"version":"2.0"}}' >none.gltf
printf 'P6\n1 1\n255\nabc' >one.ppm
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n' >m.obj && echo 'newmtl a' >m.mtl
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >m.off
printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n' >m.stl
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n' >m.ply
printf 'property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >>m.ply
echo 'LANES: 2' >c.yaml && mkdir folder && cp heard.kage folder/a.kage
expect 0 "$kage" order m.obj --eyes 2 --repeats 1 --save m.bsp
for command in "info none.gltf" "info heard.kage" "list" "diff heard.kage heard.kage" "info m.obj" "info m.off" "info m.stl" "info m.ply" \
  "render m.obj --size 8x6 --config c.yaml --out few" "order m.bsp --eyes 2 --repeats 1" "diff folder folder" "diff one.ppm one.ppm" "model tiny" "area tiny"; do
  for files in 3 4 5 6 7 8 9 10 12 16; do
    [[ $command != *" tiny" ]] || [ $files -lt 9 ] || continue # with more, Verilator or yosys runs
    rc=0
    # shellcheck disable=SC2086
    (ulimit -n $files && XDG_CACHE_HOME=$PWD/few-files exec "$kage" $command) >stdout 2>stderr || rc=$?
    [ $rc = 0 ] && continue
    [[ $rc = 127 ]] && grep -q 'shared object' stderr && continue # the loader's own words
    grep -q '^kage: yosys fails: ' stderr && [ "$command" = "area tiny" ] && continue # in the words of yosys, which has begun
    grep -qF 'no faces' stderr && [ "$command" = "info none.gltf" ] && continue
    [ $rc = 2 ] && [ "$(wc -l <stderr)" = 1 ] && grep -qiE 'too many open files|error 24' stderr || fail "ulimit -n $files, $command: exit $rc, $(cat stderr)"
    grep -qE 'not JSON|not found|cut off|is empty' stderr && fail "ulimit -n $files, $command: a wrong cause: $(cat stderr)"
  done
done
# So few threads that one cannot be started: the same. A user of its own has them, where this one may be another.
other=(setpriv --reuid=64999 --regid=64999 --clear-groups)
if "${other[@]}" "$kage" --version >/dev/null 2>&1; then
  chmod a+rx . && chmod a+r one.ppm
  for threads in 1 2 3 4 5 6 $(($(nproc) + 8)); do
    for command in "diff one.ppm one.ppm" "diff one.ppm one.ppm --perceptual"; do
      rc=0
      # shellcheck disable=SC2086
      timeout -s KILL 60 "${other[@]}" prlimit --nproc=$threads "$kage" $command >stdout 2>stderr || rc=$?
      [ $rc = 0 ] || { [ $rc = 2 ] && [ "$(wc -l <stderr)" = 1 ] && grep -qi 'temporarily unavailable' stderr; } ||
        fail "$threads threads, $command: exit $rc, $(cat stderr)"
    done
  done
  [ $rc = 0 ] || fail "$threads threads are too few: $(cat stderr)"
else
  echo "left out: few threads, as another user cannot run this build"
fi
set +o pipefail
"$kage" info heard.kage --tokens 0 2>stderr | head -n 1 >first
set -o pipefail
[ -s first ] && [ ! -s stderr ] || fail "info | head: $(cat stderr)"
done_testing
