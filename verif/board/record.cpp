// SPDX-License-Identifier: Apache-2.0
#include "board/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "board/pack_answers.hpp"
#include "cosim/report/html.hpp"
#include "cosim/report/page.hpp"
#include "cosim/session/old_evidence.hpp"
#include "file/shown.hpp"
#include "image/save.hpp"
#include "kage/diff.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "stream/finish.hpp"

namespace kage::board {
namespace {

namespace fs = std::filesystem;

report::BoardScreenRecord screen_of(const ScreenCounts& c) {
  return {.shown = c.shown, .late = c.late, .underrun_frames = c.underrun_frames, .underrun_lines = c.underrun_lines};
}

report::BoardRecord board_of(const BoardRun& run) {
  const PackVerdict& v = run.verdict;
  report::BoardRecord r;
  r.name = v.board.name;
  r.port = run.port;
  r.lines_compared = v.lines;
  r.lines_different = v.wrong_lines;
  r.registers_compared = v.registers;
  r.runs = v.runs;
  r.direct = v.direct;
  r.seconds = v.seconds;
  r.screen = screen_of(v.screen);
  r.link = {.sent = v.host.sent,
            .resent = v.host.resent,
            .damaged = v.host.answers_damaged,
            .good = v.link_good,
            .bad = v.link_bad,
            .overruns = v.link_overruns};
  if (v.loop)
    r.loop = {.frames = v.loop->frames,
              .repetitions = v.loop->repetitions,
              .lines = v.loop->lines,
              .mismatches = v.loop->mismatches,
              .seconds = v.loop->seconds,
              .left = v.loop->left,
              .screen = screen_of(v.loop->screen)};
  return r;
}

/// The frames that were compared, as cosim::run() would report them; pictures only with a folder.
class Evidence {
 public:
  Evidence(const BoardRun& run, const std::string& out, TempFiles& files, cosim::Host& host)
      : run_(run), answers_(run.folder, run.pack), out_(out), host_(host), told_(host.interrupted()), files_(files) {
    name_ = fs::path(run.pack.scene).stem().string();  // what a manifest says is no path to write to
    if (name_.empty()) name_ = "pack";
  }

  /// Ctrl-C ends it, unless that is what ended the run.
  void wait() const {
    if (!told_) host_.check();
  }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const PackAnswers& answers() const { return answers_; }
  [[nodiscard]] std::string path(const std::string& end) const { return (fs::path(out_) / (name_ + end)).string(); }

  cosim::Report report() {
    cosim::Report r;
    r.same = run_.verdict.same();
    for (std::uint64_t i = 0; i < run_.verdict.frames; ++i) {
      wait();
      cosim::FrameResult f;
      f.frame = static_cast<int>(i);
      f.status = run_.pack.frames[i].status;
      f.counts = count_tokens(run_.pack.config, answers_.words(i));
      if (i + 1 == run_.verdict.frames) r.first_difference = run_.verdict.first;
      if (!out_.empty() && run_.pack.frames[i].pixels() > 0) f.picture = draw(i);
      r.add(f, 0, 0);
    }
    r.frame_seconds.clear();  // a list is played as one
    if (!out_.empty() && !run_.verdict.captured.empty()) show_difference(r);
    return r;
  }

 private:
  std::string draw(std::uint64_t frame) {
    const FrameStatus& s = run_.pack.frames[frame].status;
    const std::string path = this->path(fmt::format("_{:04}.png", frame));
    ImageWriter writer(path, s.width, s.height, run_.pack.config.channels);
    for (int y = 0; y < s.height; ++y) writer.line(answers_.pixels(frame, y, 1));
    writer.close();
    writer.hand_over(files_);
    return path;
  }
  /// The board drew the right lines, but for those that were captured.
  void show_difference(cosim::Report& r) {
    const std::uint64_t frame = run_.verdict.captured.front().frame;
    const FrameStatus& s = run_.pack.frames[frame].status;
    Image expected(s.width, s.height, run_.pack.config.channels);
    expected.data = answers_.pixels(frame, 0, s.height);
    Image actual = expected;
    for (const CapturedLine& line : run_.verdict.captured) {
      const auto room = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(run_.pack.config.channels);
      std::copy_n(line.pixels.begin(), std::min(line.pixels.size(), room),
                  actual.data.begin() + static_cast<std::ptrdiff_t>(actual.index(0, line.line)));
    }
    Image difference;
    r.difference = diff_images(expected, actual, {}, &difference);
    const auto save = [&](const char* end, const Image& image) {
      const std::string path = this->path(fmt::format("_{:04}{}.png", frame, end));
      save_image(files_, path, image);
      r.pictures.push_back(path);
    };
    save("_expected", expected);
    save("_actual", actual);
    save("_difference", difference);
  }

  const BoardRun& run_;
  PackAnswers answers_;
  std::string out_, name_;
  cosim::Host& host_;
  bool told_;
  TempFiles& files_;
};

/// The frames as a stream file, for kage explain.
std::string write_stream(const Evidence& evidence, const BoardRun& run, TempFiles& files) {
  const std::string path = evidence.path(".kage");
  StreamFileWriter writer(path, run.pack.config);
  for (std::uint64_t i = 0; i < run.verdict.frames; ++i) {
    writer.begin_port_frame();
    writer.words(evidence.answers().words(i));
    writer.end_frame();
  }
  kage::finish(writer, files);
  return path;
}

void write_page(const Evidence& evidence, const BoardRun& run, const cosim::Report& found, const std::string& out,
                TempFiles& files, report::SceneRecord& record) {
  const Config& config = run.pack.config;
  report::Page page;
  page.record = record;
  page.run = &found;
  page.made = &files;
  page.explain = "kage explain " + quoted(write_stream(evidence, run, files));
  page.explain_rtl = " --rtl";
  report::TokenStore tokens(config, report::kPageBytes);
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(run.verdict.frames, cosim::kFrameResults); ++i) {
    evidence.wait();
    tokens.begin(static_cast<int>(i));
    tokens.words(evidence.answers().words(i));
    tokens.end();
  }
  page.tokens = &tokens;
  std::optional<report::TokenStore> wanted;
  const auto& first = found.first_difference;
  if (first && first->line >= 0 && first->frame >= 0) {
    const auto frame = static_cast<std::uint64_t>(first->frame);
    const std::vector<std::uint32_t> words = evidence.answers().words(frame);
    std::set<int> bands{first->line / report::kBandLines * report::kBandLines};
    for (const CapturedLine& c : run.verdict.captured) bands.insert(c.line / report::kBandLines * report::kBandLines);
    wanted.emplace(config, report::kPageBytes);
    wanted->choose([&](int, int line) { return line < 0 || bands.count(line) != 0; });
    wanted->begin(first->frame);
    wanted->words(words);
    wanted->end();
    page.wanted = &*wanted;
    if (first->x >= 0) {
      report::ToldPixel told;
      told.frame = first->frame;
      told.history = explain_pixel(config, words, first->x, first->line);
      page.told.push_back(std::move(told));
    }
  }
  const std::string path = (fs::path(out) / "report.html").string();
  TempFiles own;  // half a page is not to be among the others
  report::write_page(own, path, page);
  files.take(own);
  record.page = path;
  record.page_crc32 = report::checksum(files.now(path));
}

}  // namespace

report::RunRecord record_of(const BoardRun& run, const std::string& out, TempFiles& files, cosim::Host& host) {
  Evidence evidence(run, out, files, host);
  const cosim::Report found = evidence.report();
  cosim::remove_old_evidence(files, out, evidence.name(), false, {}, found);
  report::RunRecord all;
  report::SceneRecord& record = all.scenes.emplace_back();
  record.take(found);
  record.scene = run.pack.scene;
  record.total_frames = static_cast<int>(run.pack.frames.size());
  record.own_sizes = true;
  record.options.order = "exact";
  record.config_name = run.pack.config_name;
  record.config = run.pack.config;
  record.seed = run.pack.seed;
  record.rtl_seconds = run.verdict.seconds;
  record.versions = {run.kage, "pack by " + run.pack.made_by, "board " + run.verdict.board.name};
  record.again = run.again;
  record.folder = fs::current_path().string();
  record.notes = run.verdict.notes;
  record.first_difference = report::difference_record(found.first_difference, std::nullopt, false);
  record.board = board_of(run);
  if (out.empty()) return all;
  try {
    write_page(evidence, run, found, out, files, record);
  } catch (const Error& e) {
    record.notes.push_back(fmt::format("no report was written: {}", e.what()));
  }
  return all;
}

}  // namespace kage::board
