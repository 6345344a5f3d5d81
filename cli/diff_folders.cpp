// SPDX-License-Identifier: Apache-2.0
// kage diff of two folders of pictures, and --bless.
#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <optional>

#include "command.hpp"
#include "cosim/report/junit.hpp"
#include "diff.hpp"
#include "file/extension.hpp"
#include "file/quiet_stderr.hpp"
#include "image/blink.hpp"
#include "image/save.hpp"
#include "kage/bless.hpp"
#include "kage/error.hpp"
#include "mapped.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "standard_files.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

namespace fs = std::filesystem;

/// Sums over all files of two folders.
struct Totals {
  std::uint64_t pictures = 0;
  std::uint64_t different = 0;  // those that one folder lacks included
  std::uint64_t streams = 0;
  std::uint64_t others = 0;
  std::uint64_t different_files = 0;  // of streams and others
  std::uint64_t viewed = 0;
  std::uint64_t only_a = 0;  // of all
  std::uint64_t only_b = 0;
  std::uint64_t different_pixels = 0;
  std::uint64_t nan_pixels = 0;
  std::optional<std::uint64_t> max_lsb;
  std::optional<DiffResult> shape;  // of the first picture compared
  bool alike = true;                // all have its size and channels
  Json first = nullptr;
  Json frames = Json::array();
  Json files = Json::array();

  void add(const std::string& name, const DiffResult& r) {
    ++pictures;
    different += r.same ? 0 : 1;
    different_pixels += r.different_pixels;
    nan_pixels += r.nan_pixels;
    if (r.max_lsb) max_lsb = std::max(max_lsb.value_or(0), *r.max_lsb);
    if (!shape) shape = r;
    alike = alike && r.width == shape->width && r.height == shape->height && r.channels == shape->channels;
    if (r.first && first.is_null())
      first = Json{{"x", r.first->x}, {"y", r.first->y}, {"channel", r.first->channel}, {"frame", name}};
    Json frame{{"name", name}, {"missing", nullptr}};
    frame.update(cli::to_json(r));
    frames.push_back(frame);
  }

  /// A stream or another file; `reason` is empty if it is the same.
  void add_file(const FolderEntry& entry, const std::string& reason) {
    const bool stream = entry.sort == FolderEntry::Sort::stream;
    ++(stream ? streams : others);
    different_files += reason.empty() ? 0 : 1;
    const Json missing = entry.in_a && entry.in_b ? Json(nullptr) : Json(entry.in_a ? "B" : "A");
    files.push_back(Json{{"name", entry.name},
                         {"stream", stream},
                         {"missing", missing},
                         {"same", reason.empty()},
                         {"reason", reason.empty() ? Json(nullptr) : Json(reason)}});
  }

  void add_missing(const FolderEntry& entry) {
    ++(entry.in_a ? only_a : only_b);
    if (entry.sort != FolderEntry::Sort::picture) return add_file(entry, entry.in_a ? "only in A" : "only in B");
    ++pictures;
    ++different;
    Json frame{{"name", entry.name}, {"missing", entry.in_a ? "B" : "A"}};
    DiffResult nothing;
    nothing.reason = entry.in_a ? "only in A" : "only in B";
    frame.update(cli::to_json(nothing));
    frames.push_back(frame);
  }
};

Json to_json(const Totals& t, const FolderPair& pair) {
  const bool shape = t.shape && t.alike && t.shape->width != 0;
  const auto number = [](bool known, auto value) { return known ? Json(value) : Json(nullptr); };
  Json j;
  j["same"] = t.different + t.different_files == 0;
  j["width"] = number(shape, shape ? t.shape->width : 0);
  j["height"] = number(shape, shape ? t.shape->height : 0);
  j["channels"] = number(shape, shape ? t.shape->channels : 0);
  j["different_pixels"] = number(t.shape.has_value(), t.different_pixels);
  j["nan_pixels"] = number(t.shape.has_value(), t.nan_pixels);
  j["max_lsb"] = number(t.max_lsb.has_value(), t.max_lsb.value_or(0));
  j["first"] = t.first;
  j["pictures"] = t.pictures;
  j["different_pictures"] = t.different;
  j["only_in_a"] = t.only_a;
  j["only_in_b"] = t.only_b;
  j["frames"] = t.frames;
  j["files"] = t.files;
  j["different_files"] = t.different_files;
  j["not_compared"] = pair.left_out;
  return j;
}

/// The folder for heat maps and blink pictures, with its subfolders; those that are empty in the end are removed.
class Views {
 public:
  explicit Views(const std::string& path) : path_(path) {
    if (!path.empty()) folders_.emplace_back(path_);
  }

  void save(TempFiles& files, const std::string& name, const DiffViews& views) {
    const fs::path base = path_ / name;
    folders_.emplace_front(base.parent_path());
    if (views.heat.width != 0) save_image(files, fs::path(base) += ".heat.png", views.heat);
    save_blink(files, fs::path(base) += ".blink.png", views.a, views.b);
  }

 private:
  fs::path path_;
  std::list<OutFolder> folders_;
};

/// "not compared: a.json, b.txt, .git/ and 1 more"
std::string left_out(const std::vector<std::string>& names) {
  if (names.empty()) return "";
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i == 0 ? "" : ", ") + shown(names[i]);
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return fmt::format("not compared: {}\n", text);
}

/// "3 pictures, 1 stream, 2 other files"
std::string compared(const Totals& t) {
  std::string text;
  for (const auto& [count, what] : {std::pair{t.pictures, "picture"}, {t.streams, "stream"}, {t.others, "other file"}})
    if (count != 0) text += (text.empty() ? "" : ", ") + counted(count, what);
  return text;
}

/// A stream or another file that both folders have: "" if it is the same, or the lines that say how it differs.
std::string compare_other(const DiffCommand& o, const FolderEntry& entry) {
  const fs::path a = fs::path(o.a) / entry.name;
  const fs::path b = fs::path(o.b) / entry.name;
  if (entry.sort == FolderEntry::Sort::stream) {
    const auto [same, text] = compare_streams(a.string(), b.string());
    return same ? "" : text;
  }
  const std::string reason = diff_bytes(a, b);
  return reason.empty() ? "" : fmt::format("different: {}\n", reason);
}

/// The last lines: "different: 3 pictures compared, 1 differs".
std::string verdict(const DiffCommand& o, const Totals& totals, const FolderPair& pair) {
  const std::uint64_t different = totals.different + totals.different_files;
  std::string text = fmt::format("{}: {} compared", different == 0 ? "same" : "different", compared(totals));
  if (different != 0) text += fmt::format(", {} {}", different, different == 1 ? "differs" : "differ");
  if (totals.only_a != 0) text += fmt::format(", {} only in {}", totals.only_a, shown(o.a));
  if (totals.only_b != 0) text += fmt::format(", {} only in {}", totals.only_b, shown(o.b));
  text += "\n" + left_out(pair.left_out);
  if (!o.out.empty() && totals.viewed != 0) text += fmt::format("heat maps and blink pictures: {}\n", shown(o.out));
  return text;
}

}  // namespace

int diff_two_folders(const DiffCommand& o) {
  const FolderPair pair = pair_folders(o.a, o.b, o.exclude);
  if (pair.files.empty()) throw Error(fmt::format("{} and {}: neither folder holds a file to compare", o.a, o.b));
  Views views(o.out);
  TempFiles files;
  report::JUnitWriter junit(files, o.junit, "kage diff");
  DiffOptions limits = o.limits;
  if (!o.mask.empty()) {
    const QuietStderr quiet;
    limits.mask = load_mask(o.mask, limits.max_bytes);
  }
  Totals totals;
  std::string lines;
  Progress progress;
  std::size_t number = 0;
  for (const FolderEntry& entry : pair.files) {
    check_interrupt();
    progress.show(fmt::format("file {}/{}: {}", ++number, pair.files.size(), entry.name));
    const Stopwatch watch;
    if (!entry.in_a || !entry.in_b) {
      const std::string text = fmt::format("different: only in {}", shown(entry.in_a ? o.a : o.b));
      lines += fmt::format("{}: {}\n", shown(entry.name), text);
      junit.fail(entry.name, watch.seconds(), text);
      totals.add_missing(entry);
      continue;
    }
    if (entry.sort != FolderEntry::Sort::picture) {
      const std::string text = compare_other(o, entry);
      const std::string line = text.substr(0, text.find('\n'));
      totals.add_file(entry, line.substr(std::min(line.size(), std::string_view("different: ").size())));
      if (text.empty()) {
        junit.pass(entry.name, watch.seconds());
      } else {
        lines += fmt::format("{}: {}\n", shown(entry.name), line);
        junit.fail(entry.name, watch.seconds(), line, text);
      }
      continue;
    }
    DiffViews seen;
    const DiffResult r =
        compare_files(fs::path(o.a) / entry.name, fs::path(o.b) / entry.name, limits, o.out.empty() ? nullptr : &seen);
    totals.add(entry.name, r);
    if (r.same) {
      junit.pass(entry.name, watch.seconds());
      continue;
    }
    lines += fmt::format("{}: {}\n", shown(entry.name), shown(describe(r)));
    junit.fail(entry.name, watch.seconds(), describe(r), details(r));
    ++totals.viewed;
    if (!o.out.empty()) views.save(files, entry.name, seen);
  }
  progress.clear();
  junit.close();
  lines += verdict(o, totals, pair);
  finish(o.json, {"kage.diff-folders/1", to_json(totals, pair)}, files, lines);
  return totals.different + totals.different_files == 0 ? kSame : kDifferent;
}

namespace {

/// Changes that a blessing makes, or with --dry-run would make, to the files of a folder.
struct Blessed {
  std::uint64_t unchanged = 0;
  Json changed = Json::array();
  Json added = Json::array();
  Json missing = Json::array();
  Json removed = Json::array();
  std::string lines;  ///< one for each file that is not the same

  Blessed(const DiffCommand& o, const std::vector<BlessEntry>& plan) {
    for (const BlessEntry& entry : plan) add(o, entry);
  }

  [[nodiscard]] bool same(const DiffCommand& o) const {
    const bool nothing = changed.size() + added.size() + missing.size() + removed.size() == 0;
    return nothing || (!o.dry_run && missing.empty());
  }

  [[nodiscard]] Json json(const DiffCommand& o) const {
    Json j;
    j["same"] = same(o);
    j["dry_run"] = o.dry_run;
    j["unchanged"] = unchanged;
    j["changed"] = changed;
    j["added"] = added;
    j["missing"] = missing;
    j["removed"] = removed;
    return j;
  }

  /// The lines, and how many files of each sort there are.
  [[nodiscard]] std::string text(const DiffCommand& o) const {
    std::string all = lines;
    all += fmt::format("{}{}: {} the same, {} changed, {} added, {} {}", shown(o.b),
                       o.dry_run ? " (nothing is done)" : "", unchanged, changed.size(), added.size(),
                       o.prune ? removed.size() : missing.size(), o.prune ? "removed" : "missing");
    if (o.prune && !missing.empty()) all += fmt::format(", {} missing", missing.size());
    all += '\n';
    if (!missing.empty())
      all += o.prune ? "what is neither picture nor stream stays\n"
                     : fmt::format("what is missing in {} stays; --prune removes it\n", shown(o.a));
    return all;
  }

 private:
  void add(const DiffCommand& o, const BlessEntry& entry) {
    using What = BlessEntry::What;
    if (entry.what == What::same) {
      ++unchanged;
      return;
    }
    const bool goes = o.prune && entry.prunable();
    Json& names = entry.what == What::changed ? changed : entry.what == What::added ? added : goes ? removed : missing;
    names.push_back(entry.name);
    const char* const word = entry.what == What::changed ? "changed"
                             : entry.what == What::added ? "added"
                             : goes                      ? "removed"
                                                         : "missing";
    lines +=
        fmt::format("{}: {}{}{}\n", word, shown(entry.name), entry.reason.empty() ? "" : ": ", shown(entry.reason));
  }
};

}  // namespace

int bless_folder(const DiffCommand& o) {
  Progress progress;
  std::optional<QuietStderr> quiet(std::in_place);
  const auto each = [&](const std::string& name) {
    check_interrupt();
    quiet.reset();
    progress.show(name);
    quiet.emplace();
    check_mapped();
    if (lower_extension(name) != ".kage") return;
    for (const fs::path folder : {o.a, o.b}) guard_mapped((folder / name).string());
  };
  const std::vector<BlessEntry> plan = plan_bless(o.a, o.b, each, o.exclude);
  check_mapped();
  quiet.reset();
  progress.clear();
  const Blessed blessed(o, plan);
  TempFiles files;
  const auto say = [&] { finish(o.json, {"kage.diff-bless/1", blessed.json(o)}, files, blessed.text(o)); };
  if (o.dry_run)
    say();
  else
    bless(o.a, o.b, plan, o.prune, say);
  return blessed.same(o) ? kSame : kDifferent;
}

}  // namespace kage::cli
