// SPDX-License-Identifier: Apache-2.0
// Checks a line of pixel processors against kage's golden core, token by token: after each token every field of every
// pixel.
//
// +stream=FILE.kage   what to draw, at most WIDTH pixels wide, in configuration `default`
// +defect=depth|flag  a defect to make, to see it told
// The last line is "same: ..." or "different: ..."; after a difference, or where something is wrong, the simulator's
// exit code is not 0.
`default_nettype none

module pixel_bench;
  localparam int Width = 64;
  localparam int ZBits = 24;
  localparam int ZFrac = 11;

  // kage/golden.h
  import "DPI-C" function chandle kage_golden_create(input string config_name);
  import "DPI-C" function void kage_golden_destroy(input chandle core);
  import "DPI-C" function string kage_golden_error(input chandle core);
  import "DPI-C" function int kage_golden_parameter(
    input chandle core,
    input string  name
  );
  import "DPI-C" function int kage_golden_open(
    input chandle core,
    input string  path
  );
  import "DPI-C" function int kage_golden_frame(
    input chandle core,
    input int index
  );
  import "DPI-C" function int kage_golden_next(input chandle core);
  import "DPI-C" function int kage_golden_finish(input chandle core);
  import "DPI-C" function int kage_golden_token_kind(input chandle core);
  import "DPI-C" function int kage_golden_token_index(input chandle core);
  import "DPI-C" function longint kage_golden_token_field(
    input chandle core,
    input int field
  );
  import "DPI-C" function string kage_golden_token_text(input chandle core);
  import "DPI-C" function int kage_golden_width(input chandle core);
  import "DPI-C" function int kage_golden_line(input chandle core);
  import "DPI-C" function int kage_golden_pixel(
    input chandle core,
    input int x,
    input int field
  );
  import "DPI-C" function string kage_golden_pixel_name(input int field);

  localparam int Token = 1, End = 2;
  `include "kage/golden_numbers.svh"
  localparam int PixelFields = 7;  // z, three colours, class, dsf, fsf

  logic clk = 1'b0;
  logic valid = 1'b0;
  logic [3:0] kind = '0;
  logic [10:0] xl = '0, xr = '0;
  logic w = 1'b0, lit = 1'b0, bias = 1'b0;
  logic [ZBits+ZFrac+1:0] z = '0, dz = '0;
  logic [23:0] color = '0;
  logic [8:0] shade = '0;
  logic [1:0] defect = '0;

  logic [Width*ZBits-1:0] z_q;
  logic [Width*24-1:0] color_q;
  logic [Width-1:0] lit_q, dsf_q, fsf_q;

  for (genvar x = 0; x < Width; x++) begin : g_pixel
    my_pixel #(
        .X(x),
        .Z_BITS(ZBits),
        .Z_FRAC(ZFrac)
    ) u_pixel (
        .clk(clk),
        .valid(valid),
        .kind(kind),
        .xl(xl),
        .xr(xr),
        .w(w),
        .lit(lit),
        .z(z),
        .dz(dz),
        .color(color),
        .shade(shade),
        .bias(bias),
        .defect(defect),
        .z_q(z_q[x*ZBits+:ZBits]),
        .color_q(color_q[x*24+:24]),
        .lit_q(lit_q[x]),
        .dsf_q(dsf_q[x]),
        .fsf_q(fsf_q[x])
    );
  end

  chandle core;
  string stream, defect_name;
  int frames, result, checked, tokens;

  function automatic int actual(input int x, input int field);
    case (field)
      0: actual = int'(z_q[x*ZBits+:ZBits]);
      1, 2, 3: actual = int'(color_q[x*24+(field-1)*8+:8]);
      4: actual = int'(lit_q[x]);
      5: actual = int'(dsf_q[x]);
      default: actual = int'(fsf_q[x]);
    endcase
  endfunction

  // The golden core's last token to the processors; they take it in one clock.
  task automatic drive;
    kind = 4'(kage_golden_token_kind(core));
    xl = 11'(kage_golden_token_field(core, KAGE_TOKEN_XL));
    xr = 11'(kage_golden_token_field(core, KAGE_TOKEN_XR));
    z = (ZBits + ZFrac + 2)'(kage_golden_token_field(core, KAGE_TOKEN_Z));
    dz = (ZBits + ZFrac + 2)'(kage_golden_token_field(core, KAGE_TOKEN_DZ));
    w = 1'(kage_golden_token_field(core, KAGE_TOKEN_W));
    lit = 1'(kage_golden_token_field(core, KAGE_TOKEN_CLASS));
    for (int c = 0; c < 3; c++) color[c*8+:8] = 8'(kage_golden_token_field(core, KAGE_TOKEN_COLOR + c));
    if (int'(kind) == KAGE_KIND_HEADER) shade = '0;
    if (int'(kind) == KAGE_KIND_SHADE) shade = 9'(kage_golden_token_field(core, KAGE_TOKEN_SHADE));
    if (int'(kind) == KAGE_KIND_HEADER) kind = 4'(KAGE_KIND_EOL);  // the header clears the line too
    valid = 1'b1;
    #5 clk = 1'b1;
    #5 clk = 1'b0;
    valid = 1'b0;
    if (int'(kind) == KAGE_KIND_IF) bias = bias ^ w;
    if (int'(kind) == KAGE_KIND_EV || int'(kind) == KAGE_KIND_RESOLVE || int'(kind) == KAGE_KIND_EOL) bias = 1'b0;
  endtask

  task automatic check(input int frame);
    int expected;
    for (int x = 0; x < kage_golden_width(core); x++) begin
      for (int field = 0; field < PixelFields; field++) begin
        expected = kage_golden_pixel(core, x, field);
        if (expected >= 0) begin  // less: not there, or any value is right
          checked++;
          if (expected != actual(x, field)) begin
            $fatal(1, "different: frame %0d, line %0d, token %0d (%s), pixel %0d, field %s: expected %0d, got %0d",
                   frame, kage_golden_line(core), kage_golden_token_index(core), kage_golden_token_text(core), x,
                   kage_golden_pixel_name(field), expected, actual(x, field));
          end
        end
      end
    end
  endtask

  task automatic need(input string name, input int value);
    if (kage_golden_parameter(core, name) != value)
      $fatal(1, "%s is not %0d, which is all that this processor can do", name, value);
  endtask

  initial begin
    if (!$value$plusargs("stream=%s", stream)) $fatal(1, "+stream=FILE.kage is missing");
    if ($value$plusargs("defect=%s", defect_name)) begin
      if (defect_name == "depth") defect = 2'd1;
      else if (defect_name == "flag") defect = 2'd2;
      else $fatal(1, "+defect=%s: not depth or flag", defect_name);
    end
    core = kage_golden_create(stream);
    if (core == null) $fatal(1, "%s", kage_golden_error(null));
    need("Z_BITS", ZBits);
    need("Z_FRAC", ZFrac);
    need("X_BITS", 11);
    need("CHANNELS", 3);
    need("SMOOTH", 0);
    need("DSF_BITS", 1);
    need("FSF", 1);
    need("SHADE_FRAC", 8);
    need("COUNT_BITS", 0);
    need("TRANSLUCENCY", 0);
    need("UNITS", 0);
    frames = kage_golden_open(core, stream);
    if (frames < 0) $fatal(1, "%s", kage_golden_error(core));
    for (int frame = 0; frame < frames; frame++) begin
      if (kage_golden_frame(core, frame) < 0) $fatal(1, "%s", kage_golden_error(core));
      result = kage_golden_next(core);
      while (result == Token) begin
        if (kage_golden_width(core) > Width) $fatal(1, "frame %0d is wider than %0d pixels", frame, Width);
        tokens++;
        drive();
        check(frame);
        result = kage_golden_next(core);
      end
      if (result != End) $fatal(1, "frame %0d: %s", frame, kage_golden_error(core));
      if (kage_golden_finish(core) != 0) $fatal(1, "frame %0d: the golden core refuses it", frame);
    end
    kage_golden_destroy(core);
    if (checked == 0) $fatal(1, "nothing was checked");
    $display("same: %0d frames, %0d tokens, %0d values checked", frames, tokens, checked);
    $finish;
  end
endmodule

`default_nettype wire
