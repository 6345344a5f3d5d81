# SPDX-License-Identifier: Apache-2.0
# The proofs, and the defects that must be refuted: data for run.sh, which sources it.
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
#
# defect NAME PROOF FILE SED-EXPRESSION: changes FILE of rtl/, a module or a header (include/...); PROOF must refute it. Every property of a module, lemmas
#   aside, must be refuted by at least one.

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
defect right_wins_ties compare_tree_3 compare_cell.sv 's/] < left_data_i/] <= left_data_i/'
defect greatest_wins compare_tree_3 compare_cell.sv 's/] < left_data_i/] > left_data_i/'
defect waiting_pixel_lost compare_tree_3 compare_cell.sv 's/else if (free) out_valid_o <= take/else out_valid_o <= take/'
defect pixel_taken_alone compare_tree_3 compare_cell.sv 's/left_ready_o = take/left_ready_o = free \&\& left_valid_i/'
defect pixel_doubled compare_tree_3 compare_cell.sv 's/right_ready_o = take/right_ready_o = take \&\& !left_last_i/'
defect standstill compare_tree_3 compare_cell.sv 's/assign free = .*/assign free = !out_valid_o;/'
defect passing_pixel_lost compare_tree_3 compare_tree.sv 's/assign ready\[Left\] = .*/assign ready[Left] = 1;/'
defect neighbour_unseen compare_tree_3 compare_tree.sv 's/data\[(Left+1)\*/data[(Left)*/'
defect line_end_lost compare_tree_3 compare_tree.sv 's/left_last_i *(last\[Left\])/left_last_i (1'"'"'b0)/'

# ---- skid_buffer, stream_fifo ----------------------------------------------------------------------------------------
proof skid_buffer rtl=skid_buffer rules="queue_rules stream_rules" inside="inside_spare=dut.spare_q" steps=8 induction=2 cover=10
defect skid_spare_lost skid_buffer skid_buffer.sv 's/out_valid_q   <= spare_valid_q || in_valid_i/out_valid_q   <= in_valid_i/'
defect skid_word_doubled skid_buffer skid_buffer.sv 's/spare_valid_q <= 1.b0;$/spare_valid_q <= spare_valid_q;/'
defect skid_wrong_order skid_buffer skid_buffer.sv 's/spare_valid_q ? spare_q : in_data_i/in_data_i/'
defect skid_word_overwritten skid_buffer skid_buffer.sv 's/if (out_free) out_q/if (out_free || in_valid_i) out_q/'
defect skid_valid_falls skid_buffer skid_buffer.sv 's/assign out_free = .*/assign out_free = 1;/'
defect skid_ready_by_output skid_buffer skid_buffer.sv 's/assign in_ready_o = .*/assign in_ready_o = !out_valid_q;/'
defect skid_standstill skid_buffer skid_buffer.sv 's/assign out_valid_o = .*/assign out_valid_o = out_valid_q \&\& !in_valid_i;/'
defect skid_kept_in_reset skid_buffer skid_buffer.sv 's/out_valid_q   <= 1.b0;/out_valid_q   <= out_valid_q;/'
fifo_memories=([2]=gen_registers [4]=gen_registers [8]=gen_ram) fifo_cover=([2]=14 [4]=14 [8]=24)
for depth in 2 4 8; do
  fifo_memory=
  for ((word = 0; word < depth; word++)); do
    fifo_memory+=" inside_memory[$((2 * word + 1)):$((2 * word))]=\\dut.${fifo_memories[depth]}.mem[$word]"
  done
  proof stream_fifo_$depth module=stream_fifo rtl=stream_fifo rules="queue_rules stream_rules" set="DEPTH=$depth" \
    inside="inside_count=dut.count inside_oldest=dut.rd_at inside_next=dut.wr_at$fifo_memory" steps=9 induction=2 cover="${fifo_cover[depth]}"
done
defect fifo_full_unseen stream_fifo_2 stream_fifo.sv 's/assign in_ready_o  = .*/assign in_ready_o = 1;/'
defect fifo_empty_unseen stream_fifo_2 stream_fifo.sv 's/assign out_valid_o = .*/assign out_valid_o = 1;/'
defect fifo_word_lost stream_fifo_4 stream_fifo.sv 's/if (push) wr_q/if (push \&\& !out_ready_i) wr_q/'
defect fifo_word_doubled stream_fifo_4 stream_fifo.sv 's/if (pop) rd_q/if (pop \&\& !push) rd_q/'
defect fifo_capacity_unused stream_fifo_4 stream_fifo.sv 's/assign in_ready_o  = .*/assign in_ready_o = count < 3;/'
defect fifo_ready_by_valid stream_fifo_4 stream_fifo.sv 's/assign out_valid_o = .*/assign out_valid_o = count != 0 \&\& out_ready_i;/'
defect fifo_valid_falls stream_fifo_4 stream_fifo.sv 's/assign out_valid_o = .*/assign out_valid_o = count != 0 \&\& !(count == 2 \&\& in_valid_i);/'
defect fifo_data_move stream_fifo_4 stream_fifo.sv 's/assign out_data_o = .*/assign out_data_o = mem[out_ready_i ? rd_at : wr_at];/'
defect fifo_kept_in_reset stream_fifo_4 stream_fifo.sv "s/wr_q <= '0;/;/"

# ---- active_list -----------------------------------------------------------------------------------------------------
list_memory=
for ((word = 0; word < 4; word++)); do list_memory+=" inside_memory[$((4 * word + 3)):$((4 * word))]=\\dut.u_banks.mem[$word]"; done
proof active_list rtl="active_list ram_1r1w" own_assertions=yes steps=9 induction=3 defect_steps=14 cover=14 inside="inside_word=dut.word
  inside_next=dut.next_q inside_first=dut.first_q inside_read_bank=dut.read_bank_q inside_write_bank=dut.write_bank_q
  inside_loaded=dut.loaded_q inside_next_valid=dut.next_valid_q inside_first_valid=dut.first_valid_q
  inside_read_at=dut.read_at_q inside_write_at=dut.write_at_q inside_there=dut.there_q inside_left=dut.left_q
  inside_kept=dut.kept_q inside_all=dut.all_q$list_memory"
defect list_polygon_lost active_list active_list.sv 's/read_at_q + (AddrBits + 1).(read)/read_at_q + (AddrBits + 1)'"'"'(read) + (AddrBits + 1)'"'"'(pop_i \&\& read)/'
defect list_polygon_doubled active_list active_list.sv 's/loaded_q <= read || (loaded_q \&\& !next_free)/loaded_q <= read || loaded_q/'
defect list_bank_crossed active_list active_list.sv 's/{read_bank_q, read_at_q/{!read_bank_q, read_at_q/'
defect list_read_early active_list active_list.sv 's/swap_ready_o ? there_q : write_at_q/there_q/'
defect list_line_longer active_list active_list.sv 's/left_q <= swap_i ? kept_q : left_q/left_q <= swap_i ? kept_q + TallyBits'"'"'(write_i) : left_q/'
defect list_never_given active_list active_list.sv 's/first_valid_q <= (next_valid_q \&\& first_free)/first_valid_q <= (next_valid_q \&\& first_free \&\& !renew_i \&\& !write_i \&\& swap_ready_o)/'
defect list_left_late active_list active_list.sv 's/pop_i ? left_q != TallyBits.(1) : left_any_q/pop_i ? left_q != 0 : left_any_q/'
defect list_full_unseen active_list active_list.sv 's/keep_i \&\& all_q == TallyBits.(ACTIVE - 1)/1'"'"'b0/'
defect list_swap_unseen active_list active_list.sv 's/assign swap_ready_o = .*/assign swap_ready_o = 1;/'
defect list_judged_before active_list active_list.sv 's/if (first_free || renew_i)/if (first_free)/'

# ---- volume_ends -----------------------------------------------------------------------------------------------------
proof volume_ends rtl="volume_ends stream_register" own_assertions=yes steps=8 induction=2 defect_steps=10 cover=10 inside="inside_any=dut.any_q
  inside_volume=dut.volume_here_q inside_sample=dut.sample_here_q inside_there=dut.item_valid inside_family=dut.family_q
  inside_volume_xl=dut.volume_xl_q inside_volume_xr=dut.volume_xr_q inside_sample_xl=dut.sample_xl_q
  inside_sample_xr=dut.sample_xr_q inside_none=dut.is_q[5] inside_of_volume=dut.is_q[4] inside_behind=dut.is_q[3]
  inside_other_volume=dut.is_q[2] inside_other_sample=dut.is_q[1] inside_whole=dut.is_q[0] inside_kind=dut.token_q[3:0]
  inside_header=dut.flags_q[8]"
defect ends_least_lost volume_ends volume_ends.sv 's/xl < volume_xl_q/xl > volume_xl_q/'
defect ends_greatest_lost volume_ends volume_ends.sv 's/xr > volume_xr_q/1/'
defect ends_sample_narrow volume_ends volume_ends.sv 's/if (!sample_here_q || volume_xr_q > sample_xr_q)/if (!sample_here_q)/'
defect ends_volume_joined volume_ends volume_ends.sv 's/(is_q.of_volume \&\& is_q.other_volume)/1'"'"'b0/'
defect ends_unended volume_ends volume_ends.sv 's/(is_q.behind_volumes || (is_q.of_volume \&\& is_q.other_volume))/(is_q.of_volume \&\& is_q.other_volume)/'
defect ends_resolve_twice volume_ends volume_ends.sv 's/if (resolves) any_q <= 1.b0;/if (resolves) any_q <= sample_xl_q[0];/'
defect ends_token_moves volume_ends volume_ends.sv 's/assign token_index_o = index_q;/assign token_index_o = index_q + 32'"'"'(token_ready_i);/'

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
defect async_not_gray async_fifo_4 board/async_fifo.sv 's/\([wr][rd]_d\) ^ ([wr][rd]_d >> 1)/\1/
  s/{~rd_seen\[PtrBits-1:PtrBits-2\], rd_seen\[PtrBits-3:0\]}/{~rd_seen[PtrBits-1], rd_seen[PtrBits-2:0]}/'
defect async_full_unseen async_fifo_4 board/async_fifo.sv 's/assign in_ready_o = .*/assign in_ready_o = 1;/'
defect async_full_late async_fifo_4 board/async_fifo.sv 's/assign in_ready_o = wr_gray_q/logic [PtrBits-1:0] late_q; always_ff @(posedge in_clk_i) late_q <= wr_gray_q; assign in_ready_o = late_q/'
defect async_empty_unseen async_fifo_4 board/async_fifo.sv 's/assign take *= rd_gray_q != wr_seen \&\&/assign take =/'
defect async_word_overwritten async_fifo_4 board/async_fifo.sv 's/ \&\& (!out_valid_q || out_ready_i);/;/'
defect async_wrong_place async_fifo_4 board/async_fifo.sv 's/mem\[rd_q\[/mem[rd_d[/'
defect async_valid_falls async_fifo_4 board/async_fifo.sv 's/else if (out_ready_i) out_valid_q/else out_valid_q/'
defect async_kept_in_reset async_fifo_4 board/async_fifo.sv "s/out_valid_q <= 1'b0;\$/out_valid_q <= out_valid_q;/"
defect async_waits_for_two async_fifo_4 board/async_fifo.sv 's/assign take *= rd_gray_q != wr_seen/assign take = rd_gray_q != wr_seen \&\& (wr_seen[0] == wr_seen[1] || in_valid_i)/'
defect async_only_when_empty async_fifo_4 board/async_fifo.sv 's/assign in_ready_o = wr_gray_q .*/assign in_ready_o = wr_gray_q == rd_seen;/'

# ---- registers -------------------------------------------------------------------------------------------------------
proof registers_axi module=registers rtl=registers rules="lite_rules stream_rules" set="MODEL=0" steps=8 induction=2 cover=8
proof registers rtl=registers rules="lite_rules stream_rules" set="MODEL=1" steps=9 cover=9
proof registers_watchdog module=registers rtl=registers rules="lite_rules stream_rules" set="MODEL=2" steps=15 cover=13
defect axil_b_falls registers_axi registers.sv 's/if (s_axil_bvalid_o && s_axil_bready_i) s_axil_bvalid_o/if (s_axil_bvalid_o) s_axil_bvalid_o/'
defect axil_b_twice registers_axi registers.sv 's/^        aw_held_q *<= 1.b0;/        aw_held_q <= s_axil_awvalid_i;/'
defect axil_b_never registers_axi registers.sv 's/assign write = .*/assign write = aw_held_q \&\& w_held_q \&\& !s_axil_bvalid_o \&\& s_axil_bready_i;/'
defect axil_bresp_moves registers_axi registers.sv 's/if (write) s_axil_bresp_o/if (aw_held_q) s_axil_bresp_o/'
defect axil_r_falls registers_axi registers.sv 's/if (s_axil_rvalid_o && s_axil_rready_i) s_axil_rvalid_o/if (s_axil_rvalid_o) s_axil_rvalid_o/'
defect axil_rdata_move registers_axi registers.sv 's/if (s_axil_arready_o) s_axil_rdata_o/if (s_axil_arvalid_i) s_axil_rdata_o/'
defect axil_r_twice registers_axi registers.sv 's/assign s_axil_arready_o = .*/assign s_axil_arready_o = rst_ni;/'
defect axil_read_lost registers_axi registers.sv 's/assign s_axil_arready_o = .*/assign s_axil_arready_o = !s_axil_rvalid_o;/'
defect axil_r_unasked registers_axi registers.sv 's/if (s_axil_arvalid_i \&\& s_axil_arready_o) s_axil_rvalid_o/if (s_axil_arready_o) s_axil_rvalid_o/'
defect axil_r_in_reset registers_axi registers.sv "s/^      s_axil_rvalid_o *<= 1'b0;/      ;/"
defect axil_b_in_reset registers_axi registers.sv "s/^      s_axil_bvalid_o *<= 1'b0;/      ;/"
defect watchdog_late registers_watchdog registers.sv "s/at_limit_q <= idle_q ==/at_limit_q <= idle_q - 32'd1 ==/"
defect watchdog_early registers_watchdog registers.sv "s/before_last_q <= limit_q - 32'd2/before_last_q <= limit_q - 32'd3/"
defect watchdog_again registers_watchdog registers.sv 's/\&\& !bitten_q \&\&$/\&\&/; s/if (bite) bitten_q/if (bite) idle_q/'
defect watchdog_not_anew registers_watchdog registers.sv 's/assign anew = write_limit || limit_new_q || /assign anew = /'
defect watchdog_out_of_frame registers_watchdog registers.sv 's/limited_q \&\& open_q \&\& /limited_q \&\& /; s/|| progress || !open_q;/|| progress;/'
defect event_lost registers_watchdog registers.sv 's/irq_q <= irq_set | (write_irq ? \(.*\) : irq_q);/irq_q <= write_irq ? \1 : irq_set | irq_q;/'
defect strobe_ignored registers registers.sv 's/write_limit) limit_q <= .*/write_limit) limit_q <= w_data_q;/'
defect register_wrong registers registers.sv 's/RegErrorToken: value = error_token_q/RegErrorToken: value = error_frame_q/'
defect read_past_okay registers registers.sv 's/s_axil_araddr_i > RegLast/s_axil_araddr_i > RegBlocked/'
defect write_past_okay registers registers.sv "s/aw_addr_q > RegLast + 8'd3/aw_addr_q > RegLast + 8'd4/"

# ---- line_phase ------------------------------------------------------------------------------------------------------
phase_inside="inside_phase=dut.phase_q inside_marks=dut.marks_q"
proof line_phase rtl=line_phase set="DSF_BITS=2 FSF=1 COUNT_BITS=0 TRANSLUCENCY=1" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_parity module=line_phase rtl=line_phase set="DSF_BITS=1 FSF=0 COUNT_BITS=0 TRANSLUCENCY=1" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_samples module=line_phase rtl=line_phase set="DSF_BITS=2 FSF=1 COUNT_BITS=2 TRANSLUCENCY=1" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_counts module=line_phase rtl=line_phase set="DSF_BITS=2 FSF=0 COUNT_BITS=2 TRANSLUCENCY=0" inside="$phase_inside" steps=12 induction=2 cover=12
proof line_phase_plain module=line_phase rtl=line_phase set="DSF_BITS=0 FSF=0 COUNT_BITS=0 TRANSLUCENCY=1" inside="$phase_inside" steps=12 induction=2 cover=12
defect phase_op_in_volume line_phase include/generated/kage_order.svh "s/KindOp: order_in = 4'b0001/KindOp: order_in = 4'b0011/"
defect phase_end_of_no_volume line_phase line_phase.sv "s/assign with_marks = .*/assign with_marks = '0;/"
defect phase_volume_left_open line_phase include/generated/kage_order.svh 's/KindResolve: order_without = MarkVolume | /KindResolve: order_without = /'
defect phase_sample_left_open line_phase_samples line_phase.sv 's/assign without_marks = .*/assign without_marks = order_without(kind_i) \& ~MarkSample;/'
defect phase_tp_unseen line_phase line_phase.sv 's/assign resolved_o = .*/assign resolved_o = phase_q[1];/'
defect phase_bias_kept line_phase line_phase.sv "/kind_i == KindEv/s/bias_q <= '0;/;/"
defect phase_bias_not_cleared line_phase_parity line_phase.sv 's/kind_i == KindTp) bias_q/kind_i == KindTp \&\& !resolved_o) bias_q/'
defect phase_line_leaks line_phase_counts line_phase.sv "s/if (start_i) begin/if (start_i \&\& marks_q == '0) begin/"

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
defect reader_beat_lost token_reader_2 token_reader.sv 's/^    if (!full_q) begin/    if (!full_q \&\& !take) begin/'
defect reader_words_shifted token_reader_2 token_reader.sv "s/== OffBits'(o)) front/== OffBits'(o) \&\& !token_valid_q) front/"
defect reader_word_skipped token_reader_2 token_reader.sv "s/WordsBits'(HeaderWords - 1) :/WordsBits'(HeaderWords) :/"
defect reader_token_doubled token_reader_2 token_reader.sv 's/next_at_q  <= next_end_at/if (token_ready_i) next_at_q <= next_end_at/'
defect reader_cut_unseen token_reader_4 token_reader.sv 's/(next_there || last_q)/next_there/'
defect reader_rest_kept token_reader_4 token_reader.sv 's/dropping_q <= drop_i ||/dropping_q <=/'
defect reader_at_last_wrong token_reader_2 token_reader.sv 's/flags_q.at_last <= .*/flags_q.at_last <= last_q;/'
defect reader_token_moves token_reader_2 token_reader.sv 's/^    if (out_free) begin/    if (whole) begin/'
defect reader_token_falls token_reader_2 token_reader.sv 's/else if (out_free) token_valid_q <= take/else token_valid_q <= take/'
defect reader_port_falls token_reader_ports_1 token_reader.sv 's/else if (out_free) token_valid_q <= take/else token_valid_q <= take/'
defect reader_port_ready_falls token_reader_ports_4 token_reader.sv 's/assign s_axis_tready_o = rst_ni/assign s_axis_tready_o = rst_ni \&\& !(token_valid_q \&\& beats_held[0])/'
defect reader_beat_lost_in_reset token_reader_resets token_reader.sv 's/assign s_axis_tready_o = rst_ni &&/assign s_axis_tready_o =/'
defect reader_token_in_reset token_reader_resets token_reader.sv 's/if (!rst_ni) token_valid_q <= .*/if (0) ;/'
defect reader_ready_falls token_reader_2 token_reader.sv 's/assign s_axis_tready_o = rst_ni/assign s_axis_tready_o = rst_ni \&\& !(token_valid_q \&\& beats_held[0])/'
defect reader_standstill token_reader_2 token_reader.sv 's/if (last_q || (push && s_axis_tlast_i)) begin/if (push \&\& s_axis_tlast_i) begin/'
defect reader_idle_unseen token_reader_2 token_reader.sv "s/assign busy_o = .*/assign busy_o = !header_q || words_ahead != '0;/"
defect reader_moves_unseen token_reader_2 token_reader.sv 's/assign moving_o = .*/assign moving_o = take || look;/'
defect reader_look_unseen token_reader_2 token_reader.sv 's/assign moving_o = take || look/assign moving_o = take/'

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
defect out_pixel_lost line_out line_out.sv 's/if (!rst_ni) valid_q <= .*/if (!rst_ni || (start \&\& sending_q)) valid_q <= 0;/'
defect out_buffers_exchanged line_out line_out.sv "s/rd_addr_q   <= rd_second_q ? '0 : .*/rd_addr_q   <= '0;/"
defect out_address_stuck line_out_groups line_out.sv 's/rd_addr_q <= rd_addr_q + 1.b1;/rd_addr_q <= rd_addr_q;/'
defect out_lane_wrong line_out_groups line_out.sv 's/lane_at_q\[LaneBits+:LaneBits\] == LaneBits.(l)/lane_at_q[0+:LaneBits] == LaneBits'"'"'(l)/'
defect out_last_early line_out line_out.sv "s/line.width == X_BITS'(1)/1'b1/"
defect out_user_each_line line_out line_out.sv 's/first_q <= line\.first;/first_q <= 1;/'
defect out_frame_early line_out_frames line_out.sv 's/!line\.first || valid_q == .0;/1;/'
defect out_before_it_came line_out line_out.sv 's/assign next_begun = .*/assign next_begun = 1;/'
defect out_buffer_unfreed line_out line_out.sv "s/taken_q + 2'(exit_take_i) - 2'(line_left)/taken_q + 2'(exit_take_i)/"
defect out_standstill line_out_frames line_out.sv 's/assign start = .*/assign start = line_valid_i \&\& next_begun \&\& may_start \&\& taken_q[1];/'
defect out_moves_unseen line_out line_out.sv 's/assign moving_o = .*/assign moving_o = start || (go \&\& sending_q);/'
defect out_video_falls line_out skid_buffer.sv 's/assign out_free = .*/assign out_free = 1;/'
defect out_port_falls line_out_ports_plain skid_buffer.sv 's/assign out_free = .*/assign out_free = 1;/'
defect out_port_load_falls line_out_ports_loads line_out.sv 's/assign go = load_valid_o ? load_ready_i : video_go;/assign go = load_valid_o || video_go;/'
defect out_reset_lets_through line_out_resets skid_buffer.sv "s/out_valid_q   <= 1'b0;/out_valid_q <= out_valid_q;/"
defect out_rounds_down line_out_colors line_out.sv "s/(SHADE_FRAC + 9)'(HalfShare)) >>/(SHADE_FRAC + 9)'(0)) >>/"
defect out_blank_shown line_out_colors line_out.sv 's/ && !blank_at_q\[LightStages+2\]//'
defect out_load_to_video line_out_loads line_out.sv 's/valid_q\[Depth-1\] && !load_at_q\[Depth-1\]/valid_q[Depth-1]/'
defect out_load_places line_out_loads line_out.sv 's/load\.last ? .0 : load_x_q + 1.b1/load_x_q + 1'"'"'b1/'
defect out_load_moves line_out_loads line_out.sv 's/assign go = load_valid_o ? load_ready_i : video_go;/assign go = load_valid_o || video_go;/'
defect out_load_falls line_out_loads line_out.sv 's/assign load_valid_o = .*/assign load_valid_o = valid_q[Depth-1] \&\& load_at_q[Depth-1] \&\& !line_valid_i;/'
defect out_load_in_reset line_out_loads line_out.sv 's/if (!rst_ni) valid_q <= .0;/if (0) ;/'
defect out_load_early line_out_loads line_out.sv 's/if (!rst_ni) valid_q <= .0;/if (!rst_ni) valid_q <= 1;/'
defect out_loads_without line_out line_out.sv 's/assign {load_valid_o, load}.*/assign load_valid_o = m_axis_tvalid_o; assign load = 0;/'

# ---- kage_top --------------------------------------------------------------------------------------------------------
# Its defects drive a port's outputs from other ports; those within the modules are above.
proof kage_top rtl="$(cd rtl && echo *.sv | sed 's/\.sv//g')" rules="stream_rules lite_rules" steps=5 induction=2 cover=6
defect top_video_crossed kage_top kage_top.sv 's/\.\*  \/\/ m_axis_\*/.m_axis_tvalid_o(), .m_axis_tdata_o(), .m_axis_tuser_o(), .m_axis_tlast_o(), .*/; s/^endmodule/\
  assign {m_axis_tvalid_o, m_axis_tdata_o, m_axis_tuser_o, m_axis_tlast_o} = {s_axis_tvalid_i, s_axis_tdata_i[9:0]}; endmodule/'
defect top_frames_ready_in_reset kage_top kage_top.sv 's/\.\*  \/\/ s_axis_\*/.s_axis_tready_o(), .*/; s/^endmodule/assign s_axis_tready_o = 1; endmodule/'
defect top_registers_crossed kage_top kage_top.sv 's/\.\*  \/\/ s_axil_.*/.s_axil_awready_o(), .s_axil_wready_o(), .s_axil_bvalid_o(), .s_axil_bresp_o(), \
  .s_axil_arready_o(), .s_axil_rvalid_o(), .s_axil_rdata_o(), .s_axil_rresp_o(), .*/; s/^endmodule/\
  assign {s_axil_awready_o, s_axil_wready_o, s_axil_arready_o} = s_axil_wdata_i[2:0];\
  assign {s_axil_bvalid_o, s_axil_rvalid_o, s_axil_bresp_o, s_axil_rresp_o} = s_axil_wdata_i[8:3];\
  assign s_axil_rdata_o = s_axil_wdata_i; endmodule/'

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
defect sdram_suspended sdram_controller board/sdram_controller.sv 's/assign sdram_cke_o = .*/assign sdram_cke_o = !held_q;/'
defect sdram_auto_precharge sdram_controller_rows board/sdram_controller.sv 's/if (close) a_q\[10\]/if (close || column) a_q[10]/'
defect sdram_no_pause sdram_controller board/sdram_controller.sv "s/TimerBits'(Init)/TimerBits'(0)/"
defect sdram_start_short sdram_controller board/sdram_controller.sv "s/CountBits'(INIT_REFRESHES - 1)/CountBits'(0)/"
defect sdram_mode_wrong sdram_controller board/sdram_controller.sv "s/4'b0001})/4'b1001})/"
defect sdram_row_not_closed sdram_controller_rows board/sdram_controller.sv 's/assign activate = .*/assign activate = running \&\& held_q \&\& !hit \&\& may;/'
defect sdram_one_bank_closed sdram_controller board/sdram_controller.sv "s/if (close) a_q\[10\] <= 1.b1/if (close) a_q[10] <= 1'b0/"
defect sdram_rcd_short sdram_controller_rows board/sdram_controller.sv "s/WaitBits'(Rcd - 1)/WaitBits'(Rcd - 2)/"
defect sdram_rp_short sdram_controller_rows board/sdram_controller.sv "s/WaitBits'(Rp - 1)/WaitBits'(Rp - 2)/"
defect sdram_ras_short sdram_controller_rows board/sdram_controller.sv "s/CloseBits'(Ras - 1)/CloseBits'(0)/"
defect sdram_rc_short sdram_controller_rows board/sdram_controller.sv 's/localparam int Ras = .*/localparam int Ras = RasTime;/'
defect sdram_rfc_short sdram_controller board/sdram_controller.sv "s/WaitBits'(Rfc - 1)/WaitBits'(Rfc - 2)/"
defect sdram_wr_ignored sdram_controller_rows board/sdram_controller.sv 's/else if (column && write_q && close_q <= .*/else if (0) ;/'
defect sdram_mrd_short sdram_controller board/sdram_controller.sv "s/WaitBits'(CLOCKS_MRD - 1)/WaitBits'(0)/"
defect sdram_burst_cut sdram_controller_3 board/sdram_controller.sv "s/else if (column) wait_q <= WaitBits'(1)/else if (column) wait_q <= WaitBits'(0)/"
defect sdram_half_not_driven sdram_controller_rows board/sdram_controller.sv 's/assign sdram_dq_oe_o = .*/assign sdram_dq_oe_o = oe_q \&\& !half_q;/'
defect sdram_read_masked sdram_controller_3 board/sdram_controller.sv 's/masked_q <= !running;/masked_q <= !running || held_q;/'
defect sdram_turn_short sdram_controller_data board/sdram_controller.sv "s/TurnBits'(CAS_LATENCY + 2)/TurnBits'(CAS_LATENCY + 1)/"
defect sdram_no_refresh sdram_controller_quiet board/sdram_controller.sv 's/if (running && timer_q == .0) due_q <= 1.b1;//'
defect sdram_row_mixed_up sdram_controller_data board/sdram_controller.sv 's/assign hit = .*/assign hit = open_q \&\& open_bank_q == bank_q;/'
defect sdram_bank_mixed_up sdram_controller_rows board/sdram_controller.sv 's/assign hit = .*/assign hit = open_q \&\& open_row_q == row_q;/'
defect sdram_word_lost sdram_controller_3 board/sdram_controller.sv "s/if (column \&\& last) held_q <= 1.b0;/if (column) held_q <= 1'b0;/"
defect sdram_ready_said_early sdram_controller board/sdram_controller.sv 's/assign ready_o = running/assign ready_o = phase_q != Pause/'
defect sdram_idle_not_ready sdram_controller board/sdram_controller.sv 's/assign accept = running/assign accept = running \&\& open_q/'
defect sdram_both_taken sdram_controller board/sdram_controller.sv 's/assign req_ready_o = .*/assign req_ready_o = accept;/'
defect sdram_activated_again sdram_controller_rows board/sdram_controller.sv 's/if (activate) open_q <= 1.b1/if (0) open_q <= 0/'
defect sdram_word_unasked sdram_controller_rows board/sdram_controller.sv 's/, column && !write_q} :/, column} :/'
defect sdram_accepts_early sdram_controller board/sdram_controller.sv 's/assign accept = running/assign accept = (running || phase_q == Refreshes)/'
