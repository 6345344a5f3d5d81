// SPDX-License-Identifier: Apache-2.0
#include "cosim/diverge/waveform.hpp"

#include <fmt/format.h>

#include <initializer_list>
#include <string>

#include "contract/derived.hpp"
#include "cosim/diverge/replay.hpp"
#include "file/lost_pages.hpp"
#include "file/plain_io.hpp"
#include "file/shown.hpp"
#include "file/temp_file.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

// A net of kage_top.
struct Net {
  const char* name;
  int bits = 0;          // 0: not a vector. GTKWave finds a vector by its range only
  bool decimal = false;  // else hexadecimal
};

// The nets that GTKWave opens with; those of a vector's width must be as the RTL has them, which
// verif/test/cli/waveform_nets.py holds. The edge that ends a clock stands at twice its number; the marker stands half
// a clock before, where the nets have what the edge takes.
std::string save_file(const std::filesystem::path& wave, const Config& config, std::uint64_t clock) {
  std::string text =
      fmt::format("[dumpfile] \"{}\"\n[timestart] {}\n*-4.0 {}\n", std::filesystem::absolute(wave).string(),
                  clock > 20 ? 2 * (clock - 20) : 0, 2 * clock - 1);
  const auto group = [&](const char* name, std::initializer_list<Net> nets) {
    text += fmt::format("@200\n-{}\n", name);
    for (const Net& n : nets)
      text += n.bits == 0 ? fmt::format("@28\ntop.kage_top.{}\n", n.name)
                          : fmt::format("@{}\ntop.kage_top.{}[{}:0]\n", n.decimal ? 24 : 22, n.name, n.bits - 1);
  };
  const int x = config.x_bits;
  const int depth = derived::depth_bits(config);
  group("clock", {{"clk_i"}, {"rst_ni"}});
  group("token_reader to frame_control", {{"token_valid"}, {"token_ready"}, {"flags.header"}});
  group("frame_control to pixels", {{"cmd_valid"},
                                    {"cmd_ready"},
                                    {"cmd.kind", 4, true},
                                    {"cmd.xl", x, true},
                                    {"cmd.xr", x, true},
                                    {"cmd.z", depth},
                                    {"cmd.dz", depth}});
  if (config.units > 0)
    group("tree", {{"tree_valid"}, {"tree_ready"}, {"tree_pixel.z", config.z_bits}, {"tree_pixel.last"}});
  group("pixels to line_out", {{"exit_valid"}, {"exit_last"}});
  group("lines", {{"line_valid"}, {"line_ready"}, {"queue_valid"}, {"queue_ready"}});
  group("video", {{"m_axis_tvalid_o"},
                  {"m_axis_tready_i"},
                  {"m_axis_tdata_o", 8 * config.channels},
                  {"m_axis_tuser_o"},
                  {"m_axis_tlast_o"}});
  return text;
}

void record(const std::filesystem::path& path, const std::string& name, const Divergence& d, const Feed& feed,
            const Config& config, const ReplayOptions& options, const Waveform& wave) {
  // Verilator's writer maps temporary files, which on a full disk have no pages.
  guard_pages();
  const int lost = lost_pages();
  const auto rtl = make_rtl(options.library, config, options.rtl);
  const std::uint64_t end = d.clock + wave.after;
  rtl->wave(path, d.clock > wave.before ? d.clock - wave.before : 0, end);
  // A driver that records runs the core in slices, and a frame ahead by itself: as in the search, so that clocks are
  // the same. Nobody wants the events here, and those of a frame are many.
  rtl->record(true, [&] {
    (void)rtl->take_events();
    if (options.wait) options.wait();
    if (rtl->clock() > end) throw Enough();
  });
  try {
    for (int i = d.from; i <= d.frame; i += options.steps.step) {
      rtl->begin(i);
      in_pieces(feed, i, [&](std::span<const std::uint32_t> piece) {
        rtl->feed(piece, kNowhere);
        if (rtl->clock() > end) throw Enough();
      });
      (void)rtl->finish(kNowhere);
    }
  } catch (const Enough&) {
  }
  if (const int error = rtl->end_wave(); error != 0) fail_write(name, error);
  if (lost_pages() != lost) {
    forget_lost_pages(lost);
    throw Error(fmt::format("{}: cannot be written: no room for its temporary files in /tmp", name));
  }
  sync_file(path, name);
}

}  // namespace

void write_waveform(Divergence& d, const Feed& feed, const Config& config, const ReplayOptions& options,
                    const Waveform& wave) {
  TempFiles files;
  const std::string name = wave.path.string();
  if (d.ahead) {
    const Replay alone = replay_ahead(d.frame, options);
    record(files.add(wave.path), name, d, alone.feed, config, alone.options, wave);
  } else {
    record(files.add(wave.path), name, d, feed, config, options, wave);
  }
  auto path = wave.path;
  path.replace_extension(".gtkw");
  write_text(files, path.string(), save_file(wave.path, config, d.clock));
  if (wave.files != nullptr)
    wave.files->take(files);
  else
    files.commit();
  d.waveform = name;
  d.save_file = path.string();
}

std::string gtkwave_line(const std::string& save_file) { return "gtkwave " + quoted(save_file); }

}  // namespace kage::cosim
