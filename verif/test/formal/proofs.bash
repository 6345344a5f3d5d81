# SPDX-License-Identifier: Apache-2.0
# The proofs: data for run.sh, which sources it. The defects that they must refute are in defects.yaml.
# shellcheck shell=bash
#
# proof NAME KEY=VALUE...
#   module          whose proof it is; NAME if left out. The proof is verif/test/formal/MODULE_proof.sv
#   rtl, rules      files of rtl/, and of verif/test/formal or constraints/boards/sim, that it is made of
#   set             PARAMETER=VALUE... of the proof
#   inside          WIRE=NET...: wires of the proof that are nets within the module (dut), for induction
#   clocks          several: each is free; one if left out
#   own_assertions  yes: the assertions within the RTL are proved as well
#   steps           clocks from the start: the base case, or the bound
#   induction       clocks of the step; left out where the proof goes to a bound only
#   defect_steps    clocks within which a defect must be found; steps if left out
#   cover           clocks in which every cover statement must be reached; left out where another proof of the module reaches them

# ---- compare_tree ----------------------------------------------------------------------------------------------------
tree_proof() { # UNITS: the wires of the proof are the tree's own: its lowest bits, the rest is unused
  local units=$1 nodes=0 level=$1 data=5 inside='' k=0 i node at levels=0
  while [ $((1 << levels)) -lt "$units" ]; do levels=$((levels + 1)); done
  while :; do
    # A skid_buffer is behind each node of an even level but the last.
    if [ $k -gt 0 ] && [ $((k % 2)) = 0 ] && [ $k -lt $levels ]; then
      for ((i = 0; i < level; i++)); do
        node=$((nodes + i)) at="dut.gen_tree.gen_level[$((k - 1))].gen_node[$i]"
        inside+=" inside_own_valid[$node]=\\$at.own_valid inside_own_last[$node]=\\$at.own_last"
        inside+=" inside_own_data[$(((node + 1) * data - 1)):$((node * data))]=\\$at.own_data"
        inside+=" inside_spare_valid[$node]=\\$at.gen_buffer.u_buffer.spare_valid_q"
        inside+=" inside_spare[$(((node + 1) * (data + 1) - 1)):$((node * (data + 1)))]=\\$at.gen_buffer.u_buffer.spare_q"
      done
    fi
    nodes=$((nodes + level))
    [ $level -gt 1 ] || break
    level=$(((level + 1) / 2)) k=$((k + 1))
  done
  proof "compare_tree_$units" module=compare_tree rtl="compare_cell compare_tree skid_buffer" own_assertions=yes set="UNITS=$units" inside="
    inside_valid[$((nodes - 1)):0]=dut.gen_tree.valid inside_last[$((nodes - 1)):0]=dut.gen_tree.last
    inside_data[$((nodes * data - 1)):0]=dut.gen_tree.data$inside" steps=8 induction=2 cover=10
}
for units in 2 3 4 5; do tree_proof $units; done

# ---- skid_buffer, stream_fifo ----------------------------------------------------------------------------------------
proof skid_buffer rtl=skid_buffer rules="queue_rules stream_rules" inside="inside_spare=dut.spare_q" steps=8 induction=2 cover=10
fifo_memories=([2]=gen_registers [4]=gen_registers [8]=gen_ram) fifo_cover=([2]=14 [4]=14 [8]=24)
for depth in 2 4 8; do
  fifo_memory=
  for ((word = 0; word < depth; word++)); do
    fifo_memory+=" inside_memory[$((2 * word + 1)):$((2 * word))]=\\dut.${fifo_memories[depth]}.mem[$word]"
  done
  proof stream_fifo_$depth module=stream_fifo rtl=stream_fifo rules="queue_rules stream_rules" set="DEPTH=$depth" \
    inside="inside_count=dut.count inside_oldest=dut.rd_at inside_next=dut.wr_at$fifo_memory" steps=9 induction=2 cover="${fifo_cover[depth]}"
done

# ---- active_list -----------------------------------------------------------------------------------------------------
list_memory=
for ((word = 0; word < 4; word++)); do list_memory+=" inside_memory[$((4 * word + 3)):$((4 * word))]=\\dut.u_banks.mem[$word]"; done
proof active_list rtl="active_list ram_1r1w" own_assertions=yes steps=9 induction=3 defect_steps=14 cover=14 inside="inside_word=dut.word
  inside_next=dut.next_q inside_first=dut.first_q inside_read_bank=dut.read_bank_q inside_write_bank=dut.write_bank_q
  inside_loaded=dut.loaded_q inside_next_valid=dut.next_valid_q inside_first_valid=dut.first_valid_q
  inside_read_at=dut.read_at_q inside_write_at=dut.write_at_q inside_there=dut.there_q inside_left=dut.left_q
  inside_kept=dut.kept_q inside_all=dut.all_q$list_memory"

# ---- volume_ends -----------------------------------------------------------------------------------------------------
ends_inside="inside_any=dut.any_q
  inside_volume=dut.volume_here_q inside_sample=dut.sample_here_q inside_there=dut.item_valid inside_family=dut.family_q
  inside_volume_xl=dut.volume_xl_q inside_volume_xr=dut.volume_xr_q inside_sample_xl=dut.sample_xl_q
  inside_sample_xr=dut.sample_xr_q inside_none=dut.is_q[6] inside_of_volume=dut.is_q[5] inside_of_light=dut.is_q[4]
  inside_behind=dut.is_q[3] inside_other_volume=dut.is_q[2] inside_other_sample=dut.is_q[1] inside_whole=dut.is_q[0]
  inside_kind=dut.token_q[3:0] inside_header=dut.flags_q[8] inside_pass=dut.pass_here_q
  inside_samples=dut.samples_q"
proof volume_ends rtl="volume_ends stream_register" own_assertions=yes steps=8 induction=2 defect_steps=10 cover=10 inside="$ends_inside"
proof volume_ends_linear module=volume_ends rtl="volume_ends stream_register" own_assertions=yes steps=8 induction=2 defect_steps=10 \
  cover=10 inside="$ends_inside" set="LIGHTS=1 SMOOTH=1 COLOR_FRAC=4 COUNT_BITS=2 LINEAR_BITS=10"

# ---- async_fifo ------------------------------------------------------------------------------------------------------
async_cover=([4]=48 [8]=72)
for depth in 4 8 16; do
  fifo_memory=
  for ((word = 0; word < depth; word++)); do fifo_memory+=" inside_memory[$word]=\\dut.mem[$word]"; done
  proof async_fifo_$depth module=async_fifo rtl=board/async_fifo rules=undecided_synchronizer clocks=several set="DEPTH=$depth" \
    inside="inside_wr=dut.wr_q inside_rd=dut.rd_q inside_wr_gray=dut.wr_gray_q inside_rd_gray=dut.rd_gray_q
    inside_wr_meta=dut.u_wr_seen.meta_q inside_wr_seen=dut.wr_seen inside_rd_meta=dut.u_rd_seen.meta_q
    inside_rd_seen=dut.rd_seen$fifo_memory" steps=8 induction=2 defect_steps=20 cover="${async_cover[$depth]:-}"
done

# ---- registers -------------------------------------------------------------------------------------------------------
proof registers_axi module=registers rtl=registers rules="lite_rules stream_rules" set="MODEL=0" steps=8 induction=2 cover=8
proof registers rtl=registers rules="lite_rules stream_rules" set="MODEL=1" steps=9 cover=9
proof registers_watchdog module=registers rtl=registers rules="lite_rules stream_rules" set="MODEL=2" steps=15 cover=13

# ---- line_phase ------------------------------------------------------------------------------------------------------
phase_inside="inside_phase=dut.phase_q inside_marks=dut.marks_q"
proof line_phase rtl=line_phase set="DSF_BITS=2 FSF=1 COUNT_BITS=0 TRANSLUCENCY=1" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_parity module=line_phase rtl=line_phase set="DSF_BITS=1 FSF=0 COUNT_BITS=0 TRANSLUCENCY=1" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_samples module=line_phase rtl=line_phase set="DSF_BITS=2 FSF=1 COUNT_BITS=2 TRANSLUCENCY=1" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_counts module=line_phase rtl=line_phase set="DSF_BITS=2 FSF=0 COUNT_BITS=2 TRANSLUCENCY=0" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_linear module=line_phase rtl=line_phase set="DSF_BITS=2 FSF=1 COUNT_BITS=2 TRANSLUCENCY=1 LINEAR_BITS=10" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_lights module=line_phase rtl=line_phase set="DSF_BITS=2 FSF=0 COUNT_BITS=0 TRANSLUCENCY=1 LINEAR_BITS=10" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_plain module=line_phase rtl=line_phase set="DSF_BITS=0 FSF=0 COUNT_BITS=0 TRANSLUCENCY=1" inside="$phase_inside" steps=12 induction=2 cover=12

# ---- token_reader ----------------------------------------------------------------------------------------------------
reader_proof() { # NAME BEAT_WORDS STEPS SET...
  proof "$1" module=token_reader rtl=token_reader rules=stream_rules own_assertions=yes steps="$3" cover="$3" defect_steps=8 \
    set="X_BITS=8 Z_BITS=12 Z_FRAC=6 CHANNELS=1 BEAT_WORDS=$2 MAX_WORDS=$(($2 * $3)) ${*:4}"
}
reader_inside=(inside_full=dut.full_q inside_front_valid=dut.front_valid_q inside_next_at=dut.next_at_q inside_front_at=dut.front_at_q
  inside_front_end_at=dut.front_end_at_q inside_held=dut.beats_held inside_ahead=dut.words_ahead)
reader_ports() { # BEAT_WORDS BITS-OF-A-PLACE
  proof "token_reader_ports_$1" module=token_reader rtl=token_reader rules=stream_rules inside="${reader_inside[*]}" steps=6 induction=2 cover=12 \
    set="X_BITS=8 Z_BITS=12 Z_FRAC=6 CHANNELS=1 BEAT_WORDS=$1 MAX_WORDS=$((12 * $1)) InsideAtBits=$2 MODEL=0 RESETS=1"
}
reader_ports 1 5
reader_ports 2 5
reader_ports 4 6
reader_proof token_reader_1 1 10
reader_proof token_reader_2 2 9
reader_proof token_reader_4 4 9
reader_proof token_reader_resets 2 7 RESETS=1 BIT=4

# ---- line_out --------------------------------------------------------------------------------------------------------
out_proof() { # NAME STEPS DEFECT_STEPS SET...
  proof "$1" module=line_out rtl="line_out skid_buffer ram_1r1w light_resolve" rules=stream_rules own_assertions=yes \
    set="X_BITS=3 CHANNELS=1 SHADE_FRAC=2 ${*:4}" steps="$2" cover="$2" defect_steps="$3"
}
no_shadow=(DSF_BITS=0 FSF=0)
out_ports() { # NAME SET...
  proof "line_out_ports_$1" module=line_out rtl="line_out skid_buffer ram_1r1w light_resolve" rules=stream_rules steps=16 induction=2 cover=16 \
    set="X_BITS=3 CHANNELS=1 SHADE_FRAC=2 DSF_BITS=1 FOLLOWED=8 MODEL=0 RESETS=1 ${*:2}"
}
out_ports plain MAX_WIDTH=3 LANES=2
out_ports loads MAX_WIDTH=3 LANES=2 COUNT_BITS=1 TRANSLUCENCY=1
out_proof line_out 13 12 "${no_shadow[@]}" MAX_WIDTH=2 LANES=1
out_proof line_out_groups 14 13 "${no_shadow[@]}" MAX_WIDTH=3 LANES=2
out_proof line_out_frames 19 18 "${no_shadow[@]}" MAX_WIDTH=1 LANES=1 STALLS=0
out_proof line_out_resets 12 12 "${no_shadow[@]}" MAX_WIDTH=1 LANES=1 RESETS=1
out_proof line_out_colors 13 12 MAX_WIDTH=1 LANES=1 LINES=1 DSF_BITS=1 FOLLOWED=8
out_proof line_out_loads 14 14 MAX_WIDTH=2 LANES=1 DSF_BITS=1 COUNT_BITS=1 TRANSLUCENCY=1 MOST_WAIT=11

# ---- kage_top --------------------------------------------------------------------------------------------------------
proof kage_top rtl="$(cd rtl && echo *.sv | sed 's/\.sv//g')" rules="stream_rules lite_rules" steps=5 induction=2 cover=6

# ---- sdram_controller ------------------------------------------------------------------------------------------------
sdram_inside=
for word in phase timer count due held write open row open_row bank open_bank word wait close turn coming data second in low half; do
  sdram_inside+=" inside_$word=dut.${word}_q"
done
for word in rcd rp ras rc wr open rrd rfc mrd init closed drove refreshes columns beats masked due drives; do
  sdram_inside+=" rule_$word=rules.${word}_q"
done
sdram_proof() { # NAME KEY=VALUE...
  proof "$1" module=sdram_controller rtl=board/sdram_controller rules=sdram_rules inside="$sdram_inside" "${@:2}"
}
sdram_proof sdram_controller steps=14 defect_steps=22 induction=3 cover=36
sdram_proof sdram_controller_3 set=CAS_LATENCY=3 steps=14 defect_steps=29 induction=3 cover=36
sdram_proof sdram_controller_data steps=8 defect_steps=35 cover=36
sdram_proof sdram_controller_rows set=QUIET=1 steps=8 defect_steps=38 cover=30
sdram_proof sdram_controller_quiet set=QUIET=2 steps=8 defect_steps=110 cover=75
