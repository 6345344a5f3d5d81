// SPDX-License-Identifier: Apache-2.0
#include "cosim/waveform.hpp"

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <system_error>

#include "cosim/replay.hpp"
#include "files/temp_file.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

// Far more than a waveform of some hundred clocks takes while it is made.
constexpr std::uintmax_t kRoom = std::uintmax_t{32} << 20;

// A net of kage_top.
struct Net {
  const char* name;
  int bits = 0;          // 0: not a vector. GTKWave finds a vector by its range only
  bool decimal = false;  // else hexadecimal
};

// The nets that GTKWave opens with; those of a vector's width must be as the RTL has them, which
// verif/cli/waveform_nets.py holds.
std::string save_file(const std::filesystem::path& wave, const Config& config, std::uint64_t clock) {
  std::string text =
      fmt::format("[dumpfile] \"{}\"\n[timestart] {}\n*-4.0 {}\n", std::filesystem::absolute(wave).string(),
                  clock > 20 ? 2 * (clock - 20) : 0, 2 * clock + 1);
  const auto group = [&](const char* name, std::initializer_list<Net> nets) {
    text += fmt::format("@200\n-{}\n", name);
    for (const Net& n : nets)
      text += n.bits == 0 ? fmt::format("@28\ntop.kage_top.{}\n", n.name)
                          : fmt::format("@{}\ntop.kage_top.{}[{}:0]\n", n.decimal ? 24 : 22, n.name, n.bits - 1);
  };
  const int x = config.x_bits;
  const int depth = config.z_bits + config.z_frac + 2;
  group("clock", {{"clk_i"}, {"rst_ni"}});
  group("token_reader to frame_control", {{"token_valid"}, {"token_ready"}, {"token_header"}});
  group("frame_control to pixels", {{"cmd_valid"},
                                    {"cmd_ready"},
                                    {"cmd_kind", 4, true},
                                    {"cmd_xl", x, true},
                                    {"cmd_xr", x, true},
                                    {"cmd_z", depth},
                                    {"cmd_dz", depth}});
  if (config.units > 0) group("tree", {{"tree_valid"}, {"tree_ready"}, {"tree_z", config.z_bits}, {"tree_last"}});
  group("pixels to line_out", {{"exit_valid"}, {"exit_last"}});
  group("lines", {{"line_valid"}, {"line_ready"}, {"queue_valid"}, {"queue_ready"}});
  group("video", {{"m_axis_tvalid_o"},
                  {"m_axis_tready_i"},
                  {"m_axis_tdata_o", 8 * config.channels},
                  {"m_axis_tuser_o"},
                  {"m_axis_tlast_o"}});
  return text;
}

void record(const std::filesystem::path& path, int from, int frame, const Feed& feed, const Config& config,
            const DivergenceOptions& options, std::uint64_t clock) {
  const auto rtl = make_rtl(options.library, config, options.rtl);
  const std::uint64_t end = clock + options.after;
  rtl->wave(path, clock > options.before ? clock - options.before : 0, end);
  try {
    for (int i = from; i <= frame; i += options.steps.step) {
      in_pieces(feed, i, [&](std::span<const std::uint32_t> piece) {
        rtl->feed(piece, kNowhere);
        if (options.wait) options.wait();
        if (rtl->clock() > end) throw Enough();
      });
      (void)rtl->finish(kNowhere);
    }
  } catch (const Enough&) {
  }
}

}  // namespace

std::filesystem::path write_waveform(int from, int frame, const Feed& feed, const Config& config,
                                     const DivergenceOptions& options, std::uint64_t clock) {
  // Verilator's writer maps its files into memory: on a full disk that is no error but a signal.
  std::error_code ec;
  const auto folder = std::filesystem::absolute(options.waveform).parent_path();
  const std::filesystem::space_info space = std::filesystem::space(folder, ec);
  if (!ec && space.available < kRoom)
    throw Error(fmt::format("{}: less than {} MiB are free there", folder.string(), kRoom >> 20));
  TempFiles files;
  record(files.add(options.waveform), from, frame, feed, config, options, clock);
  auto path = options.waveform;
  path.replace_extension(".gtkw");
  write_text(files, path.string(), save_file(options.waveform, config, clock));
  files.commit();
  return path;
}

}  // namespace kage::cosim
