// SPDX-License-Identifier: Apache-2.0
// kage vectors: packs of test vectors: writing, checking, and judging what was captured of a core.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "command.hpp"
#include "cosim/run.hpp"
#include "cosim/session/frame_progress.hpp"
#include "cosim/session/models.hpp"
#include "cosim/session/source.hpp"
#include "file/hidden_folder.hpp"
#include "file/read_file.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "pack_history.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "standard_files.hpp"
#include "terminal.hpp"
#include "text.hpp"
#include "vectors/budget.hpp"
#include "vectors/capture.hpp"
#include "vectors/check.hpp"
#include "vectors/cover.hpp"
#include "vectors/malformed.hpp"
#include "vectors/module_pack.hpp"
#include "vectors/texts.hpp"
#include "vectors/write.hpp"

namespace kage::cli {
namespace {

/// Per cent of clocks in which each port stops while a module's ports are recorded: so all of its handshakes wait.
constexpr int kModuleStalls = 25;

struct VectorsCommand : Options {
  std::string check;
  std::vector<std::string> compare;  ///< pack, capture
  std::optional<std::uint64_t> frame;
  bool sound_only = false;
  bool no_rtl = false;
  bool sizes = false;
  bool cover = false;
  std::string module;        ///< empty: the whole core
  std::uint64_t budget = 0;  ///< bytes; 0: all lines of all frames
};

/// The frames of a pack: those of the source, then the malformed ones.
class PackFrames {
 public:
  explicit PackFrames(const VectorsCommand& o) : source_(o, terminal()) {
    if (o.budget > 0 && source_.may_be_refused())
      throw Error(o.input + ": --budget: frames that may break rules have no lines to choose");
    if (o.budget > 0 && source_.level() == Level::polygons)
      throw Error(o.input +
                  ": --budget: a line at the polygon level is nothing without the polygons that begin above it");
    if (!o.sound_only && !source_.is_random()) malformed_ = vectors::malformed_frames(source_.config(), o.seed);
    if (o.budget > 0) choose(o);
    if (o.cover) cover(o);
  }
  /// With --cover.
  [[nodiscard]] const std::optional<vectors::Cover>& covered() const { return cover_; }

  [[nodiscard]] cosim::Source& source() { return source_; }
  [[nodiscard]] int size() const { return sound() + 2 * static_cast<int>(malformed_.size()); }
  /// Whether the registers are read behind a frame with an error. Malformed frames come twice: one by one, then right
  /// behind each other.
  [[nodiscard]] bool settles(int i) const { return i < sound() + static_cast<int>(malformed_.size()); }
  [[nodiscard]] std::string what(int i) const {
    if (i >= sound()) {
      const vectors::MalformedFrame& f = damaged(i);
      return fmt::format("malformed{}: {}", f.level == Level::polygons ? ", of polygons" : "",
                         kErrorNames.at(static_cast<std::size_t>(f.status.error)));
    }
    const int from = chosen_.empty() ? i : chosen(i).from;
    return fmt::format("{}, frame {}", source_.name(), from);
  }
  /// Throws Error if the core refuses or cuts short a frame of the source that was checked as one without fault: a file
  /// with frames at the polygon level, for a core with less ACTIVE.
  void refuse_unsound(int i, const FrameStatus& status) const {
    if (i >= sound() || status.error == ErrorCode::NONE) return;
    const int from = chosen_.empty() ? i : chosen(i).from;
    if (!source_.is_unchecked(from))
      throw Error(fmt::format("{}: frame {}: the core refuses it: {}", source_.name(), from, describe(status)));
  }
  [[nodiscard]] std::vector<std::size_t> lines(int i) const {
    return i < sound() && !chosen_.empty() ? chosen(i).lines : std::vector<std::size_t>();
  }
  TokenCounts words(int i, const WordSink& sink) {
    check_interrupt();
    if (i < sound() && chosen_.empty()) return source_.frame(i, sink);
    const std::vector<std::uint32_t>& held = i < sound() ? chosen(i).words : damaged(i).words;
    sink(held);
    TokenCounts counts;
    counts.words = held.size();
    return counts;
  }

 private:
  /// So few of the source's frames that they reach what all reach.
  void cover(const VectorsCommand& o) {
    const cosim::Model model = cosim::model_of(source_.named_config(), {}, terminal(), cosim::ModelFor::kLines);
    Progress progress;
    cosim::FrameProgress frame_progress(progress, "lines reached", source_.frames());
    cover_ = vectors::cover(source_, model.library, o.seed, [&](int) {
      check_interrupt();
      frame_progress.next();
    });
    chosen_ = cover_->frames;
  }
  /// Malformed frames come first: they are small. The rest of the budget is for the hardest lines.
  void choose(const VectorsCommand& o) {
    const Config& config = source_.config();
    std::uint64_t bytes = 0;
    for (const vectors::MalformedFrame& f : malformed_)
      bytes += 2 * vectors::board_bytes(config, f.words.size(), static_cast<std::uint64_t>(f.status.height));
    if (bytes < o.budget) chosen_ = vectors::choose_lines(source_, o.budget - bytes);
    if (chosen_.empty())
      throw Error(fmt::format(
          "--budget {}: no line of {} fits{}", o.budget, source_.name(),
          bytes > 0 ? fmt::format(" beside malformed frames of {} bytes (--sound-only leaves them out)", bytes) : ""));
  }
  [[nodiscard]] int sound() const { return chosen_.empty() ? source_.frames() : static_cast<int>(chosen_.size()); }
  [[nodiscard]] const vectors::ChosenFrame& chosen(int i) const { return chosen_.at(static_cast<std::size_t>(i)); }
  [[nodiscard]] const vectors::MalformedFrame& damaged(int i) const {
    return malformed_.at(static_cast<std::size_t>(i - sound()) % malformed_.size());
  }
  cosim::Source source_;
  std::vector<vectors::ChosenFrame> chosen_;  // with --budget or --cover
  std::optional<vectors::Cover> cover_;
  std::vector<vectors::MalformedFrame> malformed_;
};

/// Measures each frame, without writing anything.
std::vector<vectors::PackFrame> measure(PackFrames& from, Progress& progress) {
  cosim::FrameProgress frame_progress(progress, "measuring", from.size());
  const Config& config = from.source().config();
  GoldenCore golden(config);
  const LineSink nowhere = [](int, std::span<const std::uint8_t>) {};
  std::vector<vectors::PackFrame> frames;
  const auto width = static_cast<std::uint64_t>(config.beat_words);
  for (int i = 0; i < from.size(); ++i) {
    frame_progress.next();
    vectors::PackFrame f;
    f.what = from.what(i);
    f.source_lines = from.lines(i);
    from.words(i, [&](std::span<const std::uint32_t> words) {
      f.words += words.size();
      golden.feed(words, nowhere);
      frame_progress.wait();
    });
    f.status = golden.finish(nowhere);
    from.refuse_unsound(i, f.status);
    f.beats = (f.words + width - 1) / width;
    f.settles = i + 1 == from.size() || (from.settles(i) && f.status.error != ErrorCode::NONE);
    frames.push_back(f);
  }
  if (std::all_of(frames.begin(), frames.end(), [](const auto& f) { return f.pixels() == 0; }))
    throw Error(from.source().name() + ": no frame brings a pixel: a pack needs one");
  constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();  // a testbench counts in 32 bits with a sign
  std::uint64_t beats = 0;
  std::uint64_t pixels = 0;
  for (const vectors::PackFrame& f : frames) {
    beats += f.beats;
    pixels += f.pixels();
  }
  if (beats > most || pixels > most)
    throw Error(fmt::format("{}: {} beats, {} pixels: a testbench counts up to {}: fewer --frames, or a smaller --size",
                            from.source().name(), beats, pixels, most));
  return frames;
}

/// The RTL plays the frames and is held against the golden model, as kage cosim does; throws Error at the first
/// difference. `ports`: ModelOptions::ports.
void play(PackFrames& from, const cosim::RtlOptions& rtl, const std::string& ports,
          const std::function<void(const cosim::FrameResult&)>& same) {
  const NamedConfig& named = from.source().named_config();
  const cosim::Model model = cosim::model_of(named, {}, terminal(), cosim::ModelFor::kPixels, ports);
  const std::unique_ptr<cosim::Core> golden = cosim::make_golden(named.config);
  const std::unique_ptr<cosim::RtlCore> core = cosim::make_rtl(model.library, named.config, rtl);
  cosim::RunOptions options;
  options.refusals = true;
  options.same = same;
  options.wait = check_interrupt;
  const cosim::Report report = cosim::run(
      from.size(), [&](int i, const WordSink& sink) { return from.words(i, sink); }, *golden, *core, options);
  if (report.same) return;
  const cosim::Difference& d = *report.first_difference;
  throw Error(fmt::format(
      "{}: the RTL differs from the golden model at line {}, x {}, {}: expected {}, got {}{}: nothing is promised",
      from.what(d.frame), d.line, d.x, d.field, d.expected, d.actual, d.remark.empty() ? "" : " (" + d.remark + ")"));
}

std::uint64_t bytes_of(const std::vector<vectors::PackFile>& files) {
  std::uint64_t bytes = 0;
  for (const vectors::PackFile& f : files) bytes += f.bytes;
  return bytes;
}

/// The bytes that --budget counts.
std::uint64_t bytes_for_board(const vectors::Pack& pack) {
  std::uint64_t bytes = 0;
  for (const vectors::PackFrame& f : pack.frames)
    bytes += vectors::board_bytes(pack.config, f.words, static_cast<std::uint64_t>(f.status.height));
  return bytes;
}

Json files_json(const std::vector<vectors::PackFile>& files) {
  Json j = Json::array();
  for (const vectors::PackFile& f : files) j.push_back({{"name", f.name}, {"bytes", f.bytes}});
  return j;
}

/// Writes a pack of the values at a module's ports while the RTL draws the frames.
int write_module_pack(PackFrames& from, const VectorsCommand& o) {
  const NamedConfig& named = from.source().named_config();
  vectors::PortsRecord record(named.config, vectors::pack_module(o.module, named.config));
  cosim::RtlOptions rtl;
  rtl.seed = o.seed;
  rtl.idle_percent = kModuleStalls;
  rtl.backpressure_percent = kModuleStalls;
  rtl.text = [&](int, std::string_view text) { say(record.text(text)); };
  Progress progress;
  cosim::FrameProgress frame_progress(progress, o.module, from.size());
  play(from, rtl, o.module, [&](const cosim::FrameResult&) { frame_progress.next(); });
  progress.clear();
  TempFiles files;
  record.write(o.out, files, from.source().name(), from.size(), "kage " KAGE_VERSION);
  Json j;
  j["pack"] = o.out;
  j["module"] = o.module;
  j["scene"] = from.source().name();
  j["frames"] = from.size();
  j["clocks"] = record.clocks();
  j["config"] = report::to_json(named.config);
  finish(o.json, {"kage.vectors-module/1", j}, files,
         fmt::format("{}{}: {} at the ports of {}, of {}\nrun it: {}\n", notes_text(from.source()), o.out,
                     counted(record.clocks(), "clock"), o.module,
                     counted(static_cast<std::uint64_t>(from.size()), "frame"),
                     (std::filesystem::path(o.out) / vectors::kReadme).string()));
  return kSame;
}

Json lines_json(const std::optional<vectors::Cover>& cover) {
  if (!cover) return nullptr;
  return {{"reached", cover->reached}, {"unreached", cover->unreached}};
}

std::string cover_text(const std::optional<vectors::Cover>& cover, int of) {
  if (!cover) return "";
  std::string text =
      fmt::format("{} of {} reach {} of {} lines and branches of the RTL, {}\n", counted(cover->frames.size(), "frame"),
                  of, cover->reached.size(), cover->reached.size() + cover->unreached.size(),
                  counted(cover->points, "kind of token and error", "kinds of tokens and errors"));
  for (const std::string& place : cover->unreached) text += fmt::format("  not reached: rtl/{}\n", place);
  return text;
}

Json summary(const vectors::Pack& pack, const std::string& folder, const std::optional<vectors::Cover>& cover) {
  Json j;
  j["pack"] = folder;
  j["scene"] = pack.scene;
  j["frames"] = pack.frames.size();
  j["malformed"] = pack.malformed();
  j["beats"] = pack.beats();
  j["lines"] = pack.lines();
  j["pixels"] = pack.pixels();
  j["clocks"] = pack.clocks() == 0 ? Json(nullptr) : Json(pack.clocks());
  j["registers"] = pack.reads.size();
  j["lines_of_rtl"] = lines_json(cover);
  j["files"] = files_json(pack.files);
  j["config"] = report::to_json(pack.config);
  return j;
}

/// A pack may be written over an older one, and over nothing else.
void refuse_other_files(const std::filesystem::path& folder) {
  std::error_code e;
  HiddenFolder::sweep(folder);  // of a run that was killed while it wrote here
  if (!std::filesystem::is_directory(folder, e) || std::filesystem::is_empty(folder, e)) return;
  const std::filesystem::path manifest = folder / vectors::kManifest;
  const std::string text = std::filesystem::is_regular_file(manifest, e) ? read_file(manifest) : std::string();
  const bool pack =
      text.find("\"kage.pack/") != std::string::npos || text.find("\"kage.module-pack/") != std::string::npos;
  if (!pack)
    throw Error(folder.string() + ": is not empty and no pack, whose files would be replaced: name another folder");
}

int write_pack(const VectorsCommand& o) {
  refuse_pack(o.input);
  if (o.out.empty() && !o.sizes) throw Error("--out: needed: the folder of the pack (or --sizes, which writes none)");
  check_json(o, o.json);
  if (o.cover && o.budget > 0) throw Error("--cover: frames that reach all are not those that fit: no --budget");
  if (o.cover && o.no_rtl) throw Error("--cover: the RTL must run to tell which of its lines are reached: no --no-rtl");
  if (!o.module.empty() && (o.sizes || o.no_rtl))
    throw Error("--module: the RTL must run to tell what passes at its ports: no --sizes, no --no-rtl");
  std::optional<OutFolder> folder;
  if (!o.sizes) {
    refuse_other_files(o.out);
    folder.emplace(o.out);
  }
  PackFrames from(o);
  if (!o.module.empty()) return write_module_pack(from, o);
  Progress progress;
  vectors::Pack pack;
  pack.scene = from.source().name();
  pack.config = from.source().config();
  pack.config_name = from.source().named_config().name;
  pack.seed = o.seed;
  pack.made_by = "kage " KAGE_VERSION;
  pack.frames = measure(from, progress);
  progress.clear();
  pack.reads = vectors::register_reads(pack.config, pack.frames);
  const std::vector<vectors::PackFile> sizes = vectors::file_sizes(pack.config, pack.frames);
  std::string text = notes_text(from.source()) + cover_text(from.covered(), from.source().frames());
  for (const vectors::PackFile& f : sizes) text += fmt::format("{:<16} {:>12} bytes\n", f.name, f.bytes);
  if (o.sizes) {
    pack.files = sizes;
    TempFiles none;
    finish(o.json, {"kage.vectors/1", summary(pack, "", from.covered())}, none,
           text + fmt::format("together {} bytes\n", bytes_of(sizes)));
    return kSame;
  }
  if (!o.no_rtl) {
    cosim::RtlOptions rtl;
    rtl.seed = o.seed;
    play(from, rtl, "", [&](const cosim::FrameResult& r) {
      vectors::PackFrame& frame = pack.frames.at(static_cast<std::size_t>(r.frame));
      // Behind a refused header no pixel comes: its clocks would be those that the driver waits for one.
      if (frame.lines() > 0) frame.clocks = r.cycles;
    });
    pack.rtl_agrees = true;
  }
  if (!json_only(o.json))
    fmt::print("{}: {}{}, files of some {} bytes\n", shown(o.out), counted(pack.frames.size(), "frame"),
               o.budget > 0 ? fmt::format(", {} of {} bytes for a board", bytes_for_board(pack), o.budget) : "",
               bytes_of(sizes));
  TempFiles files;
  vectors::PackWriter writer(o.out, pack.config, files);
  cosim::FrameProgress frame_progress(progress, pack.scene, from.size());
  for (int i = 0; i < from.size(); ++i) {
    frame_progress.next();
    const vectors::PackFrame written = writer.frame(from.what(i), [&](const WordSink& sink) {
      from.words(i, [&](std::span<const std::uint32_t> words) {
        frame_progress.wait();
        sink(words);
      });
    });
    const vectors::PackFrame& measured = pack.frames.at(static_cast<std::size_t>(i));
    if (written.words != measured.words || written.status != measured.status)
      throw Error(fmt::format("{}: the scene changed while its pack was written", measured.what));
  }
  writer.finish(pack);
  progress.clear();
  const std::string said =
      fmt::format("{}{}: {}, {} of them malformed, {}, {}, {} read, {}\nrun it: {}\n",
                  notes_text(from.source()) + cover_text(from.covered(), from.source().frames()), shown(o.out),
                  counted(pack.frames.size(), "frame"), pack.malformed(), counted(pack.beats(), "beat"),
                  counted(pack.pixels(), "pixel"), counted(pack.reads.size(), "register"),
                  pack.clocks() == 0 ? std::string("clocks not counted") : counted(pack.clocks(), "clock"),
                  shown((std::filesystem::path(o.out) / vectors::kReadme).string()));
  finish(o.json, {"kage.vectors/1", summary(pack, o.out, from.covered())}, files, said);
  return kSame;
}

int check(const VectorsCommand& o) {
  check_json(o, o.json);
  const vectors::Pack pack = vectors::checked_pack(o.check, vectors::Check::all, check_interrupt);
  reads_files(vectors::files_of(o.check, pack));
  TempFiles none;
  finish(o.json, {"kage.vectors/1", summary(pack, o.check, std::nullopt)}, none,
         fmt::format("{}: good: {}, configuration {}, {}, {}\n", shown(o.check), counted(pack.frames.size(), "frame"),
                     shown(pack.config_name), counted(pack.pixels(), "pixel"), counted(pack.files.size(), "file")));
  return kSame;
}

std::string value_text(const vectors::CaptureVerdict& v, std::optional<std::uint32_t> value) {
  if (!value) return "unknown digits";
  return v.signatures ? fmt::format("{:08x}", *value) : fmt::format("{}", *value);
}

std::string text_of(const vectors::CaptureVerdict& v, const vectors::Pack& pack) {
  const std::string compared = counted(v.compared, v.signatures ? "signature" : "pixel");
  if (v.same()) return fmt::format("same: {}\n", compared);
  std::string text = v.wrong == 0 ? fmt::format("incomplete: {}, all of them the same\n", compared)
                                  : fmt::format("different: {} of {}\n", v.wrong, compared);
  if (v.first) {
    const vectors::WrongPlace& w = *v.first;
    text += fmt::format("first difference: frame {} ({}), line {}{}, {}: expected {}, got {}\n", w.frame,
                        shown(pack.frames[w.frame].what), w.line, w.x ? fmt::format(", x {}", *w.x) : "", w.what,
                        value_text(v, w.expected), value_text(v, w.actual));
  }
  if (!v.remark.empty()) text += "the capture " + v.remark + "\n";
  return text;
}

int compare(const VectorsCommand& o) {
  reads_files({o.compare.at(1)});
  check_json(o, o.json);
  const std::string& folder = o.compare.at(0);
  const vectors::Pack pack = vectors::checked_pack(folder, vectors::Check::answers, check_interrupt);
  reads_files(vectors::files_of(folder, pack));
  const vectors::CaptureVerdict v = vectors::judge(folder, pack, o.compare.at(1), o.frame, check_interrupt);
  Json j;
  j["pack"] = folder;
  j["capture"] = o.compare.at(1);
  j["same"] = v.same();
  j["compared"] = v.compared;
  j["signatures"] = v.signatures;
  j["wrong"] = v.wrong;
  j["remark"] = v.remark;
  j["first_difference"] = nullptr;
  if (v.first)
    j["first_difference"] = {{"frame", v.first->frame},
                             {"what", pack.frames[v.first->frame].what},
                             {"line", v.first->line},
                             {"x", v.first->x ? Json(*v.first->x) : Json(nullptr)},
                             {"field", v.first->what},
                             {"expected", v.first->expected},
                             {"actual", v.first->actual ? Json(*v.first->actual) : Json(nullptr)}};
  std::string text = text_of(v, pack);
  if (v.first && v.first->x) text += history_of(pack, folder, v.first->frame, *v.first->x, v.first->line);
  TempFiles none;
  finish(o.json, {"kage.vectors-compare/1", j}, none, text);
  return v.same() ? kSame : kDifferent;
}

int run(const VectorsCommand& o) {
  const int asked = (o.input.empty() ? 0 : 1) + (o.check.empty() ? 0 : 1) + (o.compare.empty() ? 0 : 1);
  if (asked != 1) throw Error("vectors: give a SCENE, or --check PACK, or --compare PACK CAPTURE: one of them");
  if (o.frame && o.compare.empty()) throw Error("--frame: only a capture is of one frame: --compare");
  if (o.input.empty() && (!o.out.empty() || o.sizes || o.sound_only || o.no_rtl || o.cover || !o.module.empty() ||
                          o.budget > 0 || o.size_given || o.frames > 0 || !o.config.empty() || !o.level_option.empty()))
    throw Error(
        fmt::format("{} takes no option of writing a pack but --json", o.check.empty() ? "--compare" : "--check"));
  if (!o.check.empty()) return check(o);
  if (!o.compare.empty()) return compare(o);
  return write_pack(o);
}

}  // namespace

void add_vectors(Program& program, Action& action) {
  Command c = program.add(
      "vectors", "Write test vectors with known answers for any simulator or board, and judge what came out",
      "  kage vectors courtyard --size 64x48 --frames 2 --config default --out pack\n"
      "  kage vectors courtyard --size 320x240 --sizes\n"
      "  kage vectors courtyard --size 320x240 --budget 16384 --out small\n"
      "  kage vectors random:mixed --frames 500 --cover --config glass --out all\n"
      "  kage vectors random:mixed --frames 500 --cover --config polygons --front-end rtl --out all\n"
      "  kage vectors courtyard --size 16x12 --frames 1 --module pixel_banked --out module\n"
      "  kage vectors --check pack\n"
      "  kage vectors --compare pack captured.hex\n"
      "A pack has stimulus, pixels, signatures and register values, a testbench in plain Verilog and a\n"
      "README.md that says how to run it. docs/vectors.md has the form of each file.");
  const auto o = std::make_shared<VectorsCommand>();
  option_scene(c, *o, Taken::random);
  c.option("SCENE").required(false);
  c.add_option("--out", o->out, "the pack's folder").type_name("DIR");
  c.add_option("--module", o->module,
               "a pack of one module: what passes at its ports, clock by clock, while both streams stop now and then")
      .type_name("MODULE");
  c.add_flag("--sound-only", o->sound_only, "no malformed frames behind the scene's");
  c.add_flag("--no-rtl", o->no_rtl, "do not hold the RTL against the frames first, which also tells the clocks");
  c.add_option("--budget", o->budget,
               "bytes that a board has for beats and signatures: the hardest lines of the frames that fit, judged by "
               "what they reach")
      .check(whole_number(1))
      .type_name("BYTES");
  c.add_flag("--cover", o->cover,
             "of the frames take so few that they reach all lines and branches of the RTL, kinds of tokens and errors "
             "that all of them reach; say which lines none reaches");
  c.add_flag("--sizes", o->sizes, "only say how large the pack would be");
  c.add_option("--check", o->check, "verify a pack: files, hashes, and the golden model once more").type_name("PACK");
  c.add_option("--compare", o->compare, "hold a capture (.hex, .bin, .raw or a picture) against a pack")
      .expected(2)
      .type_name("PACK CAPTURE");
  c.add_option("--frame", o->frame, "the capture is of this frame of the pack alone")
      .check(whole_number())
      .type_name("N");
  options_of_frames(c, *o);
  option_front_end(c, *o);
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
