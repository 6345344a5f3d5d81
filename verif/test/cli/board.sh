#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage board: a pack on a board behind a pseudo-terminal (support/fake_board.cpp), and everything that is no board.
. "$(dirname "$0")/common.bash"
[ -x "${KAGE_FAKE_BOARD:-}" ] || { echo "KAGE_FAKE_BOARD is no program"; exit 1; }
boards=()
trap 'kill "${boards[@]}" 2>/dev/null; rm -rf "$temp"' EXIT
expect 0 "$kage" vectors courtyard --size 16x12 --frames 2 --config default --no-rtl --out pack

# board FAULT...: a board, whose device is $port until another is there.
board() {
  mkfifo name
  "$KAGE_FAKE_BOARD" pack "$@" >name &
  boards+=($!)
  read -r port <name
  rm name
}
idle() { expect 0 "$kage" board --port "$port" pack; }

# ---- what is asked for makes no sense ----
trouble "PACK is missing" "$kage" board --port /dev/null
trouble "--port is missing" "$kage" board pack
trouble "--port: its value is empty" "$kage" board --port "" pack
trouble "--baud: 0 is not a whole number" "$kage" board --port /dev/null --baud 0 pack
trouble "--timeout: 0 is not in 0.001 .. 86400" "$kage" board --port /dev/null --timeout 0 pack
trouble "--loop: -1 is not in 0 .. 10000000" "$kage" board --port /dev/null --loop -1 pack
trouble "--leave: only frames that are played over and over can be left" "$kage" board --port /dev/null --leave pack
trouble "sim: needs a board's name behind it" "$kage" board --port sim: pack
trouble "--baud: a board in simulation has no rate" "$kage" board --port sim:nothing --baud 9600 pack
trouble "kage: sim:nothing: no board with a simulation; there are ulx3s_25f" "$kage" board --port sim:nothing pack
trouble "nowhere/manifest.json: is not there: no pack" "$kage" board --port /dev/null nowhere
trouble "/dev/nothing: no such device" "$kage" board --port /dev/nothing pack
trouble "/dev/null: is not a terminal" "$kage" board --port /dev/null pack
trouble "this output would overwrite an input" "$kage" board --port /dev/null pack --json pack/pixels.bin
cp -r pack damaged
printf x >>damaged/pixels.bin
trouble "damaged/pixels.bin: has" "$kage" board --port /dev/null damaged
expect 0 "$kage" vectors --check pack

# ---- nobody behind the port ----
board
kill -STOP "${boards[-1]}"
begin=$SECONDS
trouble "$port: no kage board answers at 3000000 baud, nor at 115200, " "$kage" board --port "$port" pack
[ $((SECONDS - begin)) -lt 20 ] || fail "silence takes $((SECONDS - begin)) s to notice"
trouble "77 baud is not possible; possible are" "$kage" board --port "$port" --baud 77 pack
kill -KILL "${boards[-1]}"

# ---- the same ----
board
expect 0 "$kage" board --port "$port" pack --json same.json --out out
grep -qE "^same: [0-9]+ frames, up to 16x12, .* lines, [0-9]+ registers, board FAKE [0-9.]+ s$" stdout || fail "$(cat stdout)"
grep -qE "^board FAKE at $port: [0-9]+ lists played; link: [0-9]+ packets sent, 0 of them again, 0 came damaged$" stdout || fail "$(cat stdout)"
grep -q "^report: out/report.html$" stdout || fail "no page: $(cat stdout)"
python3 - <<'PY' || fail "the JSON is not what the pack has"
import json, sys
j, m = json.load(open("same.json")), json.load(open("pack/manifest.json"))
b = j["board"]
lines = sum(f["height"] for f in m["frames"] if f["width"])
ok = j["schema"] == "kage.cosim/1" and j["same"] and j["frames"] == len(m["frames"]) and j["first_difference"] is None
ok = ok and b["lines_compared"] == lines and b["lines_different"] == 0 and b["registers_compared"] == len(m["registers"])
sys.exit(not (ok and b["name"] == "FAKE" and b["loop"] is None and b["screen"]["shown"] == 0))
PY
expect 0 "$kage" board --port "$port" pack --json -
python3 -c 'import json,sys; json.load(open("stdout"))' || fail "--json - is not JSON alone"
idle

# ---- over and over ----
expect 0 "$kage" board --port "$port" pack --loop 0.5 --json loop.json
json loop.json 'j["board"]["loop"]["repetitions"] > 5 and j["board"]["loop"]["mismatches"] == 0 and not j["board"]["loop"]["left"]'
"$kage" board --port "$port" pack --loop 0 >looped &
pid=$!
sleep 2
kill -INT $pid
wait $pid || fail "Ctrl-C does not end a loop with its verdict: $?"
grep -q "^over and over: .* 0 of .* lines different$" looped || fail "$(cat looped)"
expect 0 "$kage" board --port "$port" pack --loop 0.2 --leave
grep -q "the board goes on$" stdout || fail "$(cat stdout)"
idle
kill "${boards[-1]}"

# ---- different ----
board line 5
expect 1 "$kage" board --port "$port" pack --json line.json --out out
json line.json 'not j["same"] and j["first_difference"]["frame"] == 0 and j["first_difference"]["line"] <= 5 and j["first_difference"]["x"] == 15'
json line.json 'abs(j["first_difference"]["expected"] - j["first_difference"]["actual"]) == 32'
grep -q "^the pixel's history: " stdout || fail "no history: $(cat stdout)"
for picture in expected actual difference; do [ -s out/courtyard_0000_$picture.png ] || fail "no picture of what is $picture"; done
expect 1 "$kage" diff out/courtyard_0000_expected.png out/courtyard_0000_actual.png
expect 0 "$kage" explain out/courtyard.kage --frame 0 --pixel 15,5
kill "${boards[-1]}"
board once 5
expect 1 "$kage" board --port "$port" pack --out out
grep -q "^first difference: frame 0, line 5, signature: .*the fault does not repeat" stdout || fail "$(cat stdout)"
[ ! -e out/courtyard_0000_actual.png ] || fail "a picture of another run is left"
kill "${boards[-1]}"
board hang 1
expect 1 "$kage" board --port "$port" pack --timeout 0.3
grep -q "^first difference: frame 1, line 1: only 16 of 192 pixels came: the core hangs: nothing more comes in 0.3 s: STATUS " stdout || fail "$(cat stdout)"
kill "${boards[-1]}"
board screen
expect 0 "$kage" board --port "$port" pack
grep -qE "^screen: [0-9]+ frames shown, .* with lines too late, [0-9]+ lines of them$" stdout || fail "$(cat stdout)"
kill "${boards[-1]}"

# ---- trouble ----
board hash
trouble "load a bitstream of default, or make the pack with" "$kage" board --port "$port" pack --json none.json --out none
[ ! -e none.json ] && [ ! -e none ] || fail "trouble leaves files"
kill "${boards[-1]}"
board memory 3
trouble "the memory gives other words than were loaded into it, first in frame 0 (courtyard, frame 0)" "$kage" board --port "$port" pack
kill "${boards[-1]}"
board silent 3
trouble "board FAKE: the memory gives no more words behind word 2 of frame 0, and the core waits for them" "$kage" board --port "$port" pack --timeout 0.3
kill "${boards[-1]}"
board back 1
begin=$SECONDS
trouble "board FAKE: LINES goes back from " timeout 30 "$kage" board --port "$port" pack --timeout 0.5
[ $((SECONDS - begin)) -lt 10 ] || fail "a counter that goes back takes $((SECONDS - begin)) s to notice"
kill "${boards[-1]}"
board reset 30
trouble "the board was reset while it " "$kage" board --port "$port" pack
idle
kill "${boards[-1]}"
no_leftovers
done_testing
