// SPDX-License-Identifier: Apache-2.0
#include "vectors/texts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cosim/model/driver/idle.hpp"
#include "kage/defs.hpp"
#include "kage/registers.h"
#include "number/counted.hpp"

namespace kage::vectors {
namespace {

constexpr const char* kLicense = "SPDX-License-Identifier: Apache-2.0";

std::string parameters(const Config& config, const char* form, const char* between) {
  std::string text;
  for (const ParamInfo& p : kParams) {
    if (!text.empty()) text += between;
    text += fmt::format(fmt::runtime(form), p.name, config.*p.member);
  }
  return text;
}

/// NAME, value and what it is, of all macros that both headers have.
struct Macro {
  const char* name;
  std::uint64_t value;
  const char* what;
};
// At least what a core sweeps after reset, whatever a netlist does to it.
std::uint64_t quiet_clocks(const Config& c) {
  return std::max<std::uint64_t>(
      100'000, idle_clocks(static_cast<std::uint64_t>(c.max_width), static_cast<std::uint64_t>(c.lanes),
                           static_cast<std::uint64_t>(c.active)));
}

std::vector<Macro> macros(const Pack& p) {
  return {{"BEAT_WORDS", static_cast<std::uint64_t>(p.config.beat_words), "32-bit words in a beat of s_axis"},
          {"CHANNELS", static_cast<std::uint64_t>(p.config.channels), "bytes of a pixel on m_axis"},
          {"FRAMES", p.frames.size(), "frames"},
          {"BEATS", p.beats(), "beats of all frames"},
          {"LINES", p.lines(), "lines of all frames that come out"},
          {"PIXELS", p.pixels(), "pixels of all frames that come out"},
          {"READS", p.reads.size(), "registers that are read"},
          {"QUIET", quiet_clocks(p.config), "clocks without a move at any port behind which the core counts as hung"}};
}

}  // namespace

std::string frames_hex(const Pack& pack) {
  std::string text;
  for (const PackFrame& f : pack.frames)
    text += fmt::format("{:08x}{:08x}{:08x}{:08x}\n", f.beats, f.status.height, f.status.width, f.settles ? 1 : 0);
  return text;
}

std::string registers_hex(const Pack& pack) {
  std::string text;
  for (const RegisterRead& r : pack.reads)
    text += fmt::format("{:08x}{:08x}{:08x}{:08x}\n", r.frame, r.address, r.mask, r.value);
  return text;
}

std::string verilog_header(const Pack& pack) {
  std::string text =
      fmt::format("// {}\n// {}: sizes of the pack and parameters of its core.\n", kLicense, kVerilogHeader);
  for (const Macro& m : macros(pack)) text += fmt::format("`define KAGE_PACK_{} {}  // {}\n", m.name, m.value, m.what);
  text += fmt::format("`define KAGE_PACK_REG_FRAMES 8'h{:02x}  // counts frames that have ended\n", KAGE_REG_FRAMES);
  text += "`define KAGE_PACK_PARAMETERS \\\n  " + parameters(pack.config, ".{}({})", ", \\\n  ") + "\n";
  return text;
}

std::string c_header(const Pack& pack, std::span<const std::uint32_t> signatures) {
  std::string text =
      fmt::format("/* {}\n * {}: sizes of the pack, its frames, signatures and registers; docs/vectors.md. */\n",
                  kLicense, kCHeader);
  text += "#ifndef KAGE_PACK_H\n#define KAGE_PACK_H\n\n#include <stdint.h>\n\n";
  for (const Macro& m : macros(pack))
    text += fmt::format("#define KAGE_PACK_{} {} /* {} */\n", m.name, m.value, m.what);
  text += parameters(pack.config, "#define KAGE_PACK_{} {}", "\n") + "\n";
  // BEAT_WORDS and CHANNELS are parameters too: told once.
  for (const char* twice : {"BEAT_WORDS", "CHANNELS"}) {
    const std::string line = fmt::format("#define KAGE_PACK_{} ", twice);
    const std::size_t second = text.rfind(line);
    text.erase(second, text.find('\n', second) + 1 - second);
  }
  text +=
      "\n/* A frame: its beats in stimulus.bin, the lines and pixels of a line that come out, and its error, 0 for "
      "none. */\n"
      "struct kage_pack_frame {\n  uint32_t beats, lines, width;\n  uint8_t error, registers_are_read;\n};\n"
      "static const struct kage_pack_frame kage_pack_frames[KAGE_PACK_FRAMES] = {\n";
  for (const PackFrame& f : pack.frames)
    text += fmt::format("    {{{}, {}, {}, {}, {}}},\n", f.beats, f.status.height, f.status.width,
                        static_cast<int>(f.status.error), f.settles ? 1 : 0);
  text +=
      "};\n\n/* A register that is read behind a frame: (value read & mask) == value. */\n"
      "struct kage_pack_register {\n  uint32_t frame, address, mask, value;\n};\n"
      "static const struct kage_pack_register kage_pack_registers[KAGE_PACK_READS] = {\n";
  for (const RegisterRead& r : pack.reads)
    text +=
        fmt::format("    {{{}, {:#04x}, {:#010x}, {:#010x}}}, /* {} */\n", r.frame, r.address, r.mask, r.value, r.name);
  text +=
      "};\n\n/* CRC-32 of each line, as zlib has it: of each pixel its channels, then TLAST + 2 TUSER. */\n"
      "static const uint32_t kage_pack_signatures[KAGE_PACK_LINES] = {\n";
  for (std::size_t i = 0; i < signatures.size(); i += 8) {
    text += "   ";
    for (const std::uint32_t s : signatures.subspan(i, std::min<std::size_t>(8, signatures.size() - i)))
      text += fmt::format(" {:#010x},", s);
    text += '\n';
  }
  text += "};\n\n#endif\n";
  return text;
}

std::string readme(const Pack& pack) {
  std::string text = fmt::format(
      "# Test vectors: {}, configuration {}\n\n"
      "{}, {} of them malformed: {}, {}. What goes in, beat by beat, and every pixel that must come out of kage,\n"
      "the span-stream rendering core, in this configuration. `manifest.json` names each file with its SHA-256.\n\n",
      pack.scene, pack.config_name, counted(pack.frames.size(), "frame"), pack.malformed(),
      counted(pack.beats(), "beat"), counted(pack.pixels(), "pixel"));
  text +=
      "Run it in this folder; RTL is the core's folder `rtl`:\n\n"
      "```sh\n"
      "iverilog -g2012 -IRTL/include -o pack.vvp kage_pack_tb.v RTL/*.sv RTL/kage_axi.v && vvp pack.vvp +seed=1 "
      "+stall=20\n"
      "verilator --binary --timing -Wno-fatal -IRTL/include --top-module kage_pack_tb kage_pack_tb.v RTL/*.sv "
      "RTL/kage_axi.v\n"
      "obj_dir/Vkage_pack_tb +seed=1 +stall=20\n"
      "```\n\n"
      "Exactly one line begins with `kage_pack_tb: `: `passed: ...`, or `FAILED: ...` with frame, line, x, channel "
      "and\n"
      "clock. While Icarus Verilog 11 compiles, it prints lines with `sorry: `, about constant selects and about\n"
      "`Case unique/unique0 qualities`: all are harmless. Version 11.0 comes to no end with some cores, by a defect "
      "of\n"
      "its own; it plays those from a copy of the RTL after `sed -i 's/\\balways_comb\\b/always @*/' COPY/*.sv`. For "
      "a\n"
      "netlist: add `-DKAGE_PACK_NETLIST`, and name its file in place of the RTL's.\n\n"
      "| file | a line, or an entry |\n|---|---|\n"
      "| `stimulus.hex` | a beat of `s_axis`: a digit TLAST, then TDATA |\n"
      "| `stimulus.bin` | the same beats, without TLAST, words little-endian |\n"
      "| `pixels.hex` | a pixel of `m_axis`: a digit 2 TUSER + TLAST, then TDATA |\n"
      "| `pixels.bin` | the same pixels, a byte a channel, channel 0 first |\n"
      "| `signatures.hex` | CRC-32 of a line (zlib's): of each pixel its channels, then a byte 2 TUSER + TLAST |\n"
      "| `frames.hex` | a frame: beats (the highest bits), height, width, whether registers are read behind it; 32 "
      "bits "
      "each |\n"
      "| `registers.hex` | a read: behind which frame (the highest bits), address, mask, value; 32 bits each |\n"
      "| `kage_pack.vh`, `kage_pack.h` | the sizes and parameters for Verilog; for C with frames, registers, "
      "signatures |\n"
      "| `kage_pack_tb.v` | the testbench, plain Verilog-2005 |\n\n"
      "`kage vectors --check` verifies the pack, `kage vectors --compare` judges what a board has captured.\n";
  return text;
}

}  // namespace kage::vectors
