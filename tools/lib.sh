# SPDX-License-Identifier: Apache-2.0
# Shared by the scripts of this folder: source it, do not run it.
# shellcheck shell=bash
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${KAGE_BUILD:-$top/build/release}
build_type=Release
unity=ON # a build that is made once: cmake/KageBuild.cmake
log_dir=$top/build/log
# shellcheck disable=SC2034 # who sources this uses it
jobs=${KAGE_JOBS:-$(nproc)}
. "$top/tools/pypi.sh"
child=

# Stops what is running, with all that it started. Steps run in process groups of their own.
stop() {
  trap - INT TERM
  [ -z "$child" ] || kill -TERM -- "-$child" 2>/dev/null || true
  exit 130
}
trap stop INT TERM

# step NAME TITLE COMMAND...: runs the command with its output in build/log/NAME.log. On a terminal the last line of output
# passes by; in a pipe there is a line at the start, one a minute, and one at the end. On failure: the end of the log and its place.
step() {
  local name=$1 title=$2 start=$SECONDS width tick=0 rc=0
  shift 2
  mkdir -p "$log_dir"
  local log=$log_dir/$name.log
  if [ -t 1 ]; then width=$(( $(tput cols 2>/dev/null || echo 80) - ${#title} - 12 )); else echo "$title ..."; fi
  set -m
  "$@" >"$log" 2>&1 </dev/null &
  child=$!
  set +m
  while kill -0 "$child" 2>/dev/null; do
    sleep 0.25
    tick=$((tick + 1))
    if [ -t 1 ]; then
      printf '\r\033[K%s %3ds %.*s' "$title" $((SECONDS - start)) $((width > 0 ? width : 0)) "$(tail -c 300 "$log" | tr '\r' '\n' | tail -n 1)"
    elif [ $((tick % 240)) = 0 ]; then
      printf '  %ds: %.100s\n' $((SECONDS - start)) "$(tail -n 1 "$log")"
    fi
  done
  wait "$child" || rc=$?
  child=
  [ ! -t 1 ] || printf '\r\033[K'
  if [ $rc = 0 ]; then
    echo "$title: done in $((SECONDS - start)) s"
  else
    echo "$title: FAILED after $((SECONDS - start)) s, the end of its log:" >&2
    tail -n 30 "$log" >&2
    echo "log: $log" >&2
  fi
  return $rc
}

# at_once FOLDER FUNCTION ITEM...: runs the function for each item, as many at once as there are processors, each with its output in
# FOLDER/FUNCTION-ITEM.log and .err; then prints that output, item by item. Functions and variables that it uses must be exported. Exit code 1: one failed.
at_once() {
  local folder=$1 function=$2 item rc=0
  shift 2
  mkdir -p "$folder"
  export -f "${function?}"
  printf '%s\0' "$@" | xargs -0 -n 1 -P "$jobs" bash -o pipefail -uc '"$1" "$3" >"$2/$1-$3.log" 2>"$2/$1-$3.err"' at_once "$function" "$folder" || rc=1
  for item in "$@"; do cat "$folder/$function-$item.log" && cat "$folder/$function-$item.err" >&2; done
  return $rc
}

# configure ON|OFF: the build of $build_type in $build, with tests or without; a build that has tests keeps them.
configure() {
  if [ -f "$build/build.ninja" ] && { [ "$1" = OFF ] || grep -q '^KAGE_TESTS:BOOL=ON' "$build/CMakeCache.txt"; }; then return 0; fi
  step configure "configuring" cmake -S "$top" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE="$build_type" -DKAGE_TESTS="$1" -DKAGE_BENCH="$1" -DKAGE_UNITY="$unity"
}
