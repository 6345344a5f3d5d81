#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Frames and bands of lines flow through: peak memory grows neither with a frame's height nor with the number of frames. A large
# mesh with shadows stays below 1 GiB. The tall frames hold 38 MB of pixels more, or 56 MB of words (knot), and the many nearly
# as much: what keeps either is seen. Programs begin at some 12 MB, and Python, which starts them, at 14. The first frames of a
# run take up to 6 MB until every thread and queue has the memory that it uses again and again. So the others are held against a
# run of four.
. "$(dirname "$0")/common.bash"

# least VARIABLE COMMAND...: the smaller of the command's peak resident memory in KiB and the variable's value, if it has one. A
# program that keeps memory keeps it every time; how far two threads are apart when the allocator asks for more is chance. So a
# limit is passed if one run of three keeps it.
least() {
  local -n kept=$1
  local peak
  shift
  peak=$(python3 - "$@" 2>stderr <<'PY'
import ctypes, resource, subprocess, sys
# Where the kernel gives huge pages unasked, it counts memory that nobody touched (PR_SET_THP_DISABLE).
ctypes.CDLL(None).prctl(41, 1, 0, 0, 0)
rc = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL).returncode
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss if rc == 0 else 0)
PY
  ) || peak=0
  [ "$peak" -gt 0 ] || { fail "$*"; sed 's/^/    /' stderr; }
  kept=$((peak < ${kept:-peak} ? peak : ${kept:-peak}))
}

# flat TALL COMMAND...: {H} stands for the frame's height, 480 or TALL, {N} for the number of frames.
flat() {
  local high=$1 low='' tall='' many='' command
  shift
  for _ in 1 2 3; do
    command=("${@//'{H}'/480}")
    least low "${command[@]//'{N}'/4}"
    least many "${command[@]//'{N}'/28}"
    command=("${@//'{H}'/$high}")
    least tall "${command[@]//'{N}'/1}"
    [ $((tall - low)) -gt 12288 ] || [ $((many - low)) -gt 12288 ] || break
  done
  echo "$2: $low KiB for 4 frames of 640x480, $many for 28, $tall for one of 640x$high"
  [ $((tall - low)) -le 12288 ] || fail "$2: $((tall - low)) KiB more for a frame of $high lines"
  [ $((many - low)) -le 12288 ] || fail "$2: $((many - low)) KiB more for 28 frames than for 4"
}

"$kage" model default >/dev/null || fail "no RTL model"
flat 15360 "$kage" cosim courtyard --size '640x{H}' --frames '{N}' --out c
flat 15360 "$kage" render courtyard --size '640x{H}' --frames '{N}' --out r
flat 7680 "$kage" stream knot --size '640x{H}' --frames '{N}' --out s.kage

# Two stream files: what is in memory is the frame at hand.
for n in 1 12; do "$kage" stream knot --size 640x480 --frames $n --out knot$n.kage >/dev/null || fail "no stream"; done
one='' twelve=''
for _ in 1 2 3; do
  least one "$kage" diff knot1.kage knot1.kage
  least twelve "$kage" diff knot12.kage knot12.kage
  [ $((twelve - one)) -gt 8192 ] || break
done
echo "diff: $one KiB for streams of 1 frame, $twelve for 12, which are $(($(stat -c %s knot12.kage) / 1024)) KiB each"
[ $((twelve - one)) -le 8192 ] || fail "diff: $((twelve - one)) KiB more for streams of 12 frames"

# A mesh of 102,400 faces that is not convex, on a sheet, with shadows.
python3 - >big.obj <<'PY'
import math
n, m = 320, 160
points = []
for j in range(m + 1):
    for i in range(n):
        a, b = 2 * math.pi * i / n, math.pi * j / m
        r = 1 + 0.12 * math.sin(7 * a) * math.sin(5 * b) + 0.05 * math.sin(23 * a + 3 * b) * math.sin(b)
        points.append((r * math.sin(b) * math.cos(a), r * math.cos(b), r * math.sin(b) * math.sin(a)))
points += [(-3, -1.3, -3), (-3, -1.3, 3), (3, -1.3, 3), (3, -1.3, -3)]
for p in points:
    print("v %.6f %.6f %.6f" % p)
for j in range(m):
    for i in range(n):
        k = (i + 1) % n
        a, b, c, d = j * n + i + 1, j * n + k + 1, (j + 1) * n + k + 1, (j + 1) * n + i + 1
        print("f %d %d %d\nf %d %d %d" % (a, b, c, a, c, d))
print("f %d %d %d %d" % tuple(len(points) - k for k in (3, 2, 1, 0)))
PY
for command in render cosim; do
  kib=''
  least kib "$kage" $command big.obj --size 1280x720 --frames 1 --out big
  echo "$command: $kib KiB for 102,400 faces at 1280x720"
  [ "$kib" -le 1048576 ] || fail "$command of a large mesh: $kib KiB"
done
done_testing
