// SPDX-License-Identifier: Apache-2.0
// kage diff of two folders of pictures, and --bless.
#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <optional>

#include "diff.hpp"
#include "image/flip.hpp"
#include "image/save.hpp"
#include "junit.hpp"
#include "kage/error.hpp"

namespace kage::cli {
namespace {

namespace fs = std::filesystem;

/// What all pictures of two folders come to.
struct Totals {
  std::uint64_t pictures = 0;
  std::uint64_t different = 0;  // those that one folder lacks included
  std::uint64_t only_a = 0;
  std::uint64_t only_b = 0;
  std::uint64_t different_pixels = 0;
  std::uint64_t nan_pixels = 0;
  std::optional<std::uint64_t> max_lsb;
  std::optional<DiffResult> shape;  // of the first picture compared
  bool alike = true;                // all have its size and channels
  Json first = nullptr;
  Json frames = Json::array();

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
    frame.update(to_json(r));
    frames.push_back(frame);
  }

  void add_missing(const FolderEntry& entry) {
    ++pictures;
    ++different;
    ++(entry.in_a ? only_a : only_b);
    Json frame{{"name", entry.name}, {"missing", entry.in_a ? "B" : "A"}};
    DiffResult nothing;
    nothing.reason = entry.in_a ? "only in A" : "only in B";
    frame.update(to_json(nothing));
    frames.push_back(frame);
  }
};

Json to_json(const Totals& t, const FolderPair& pair) {
  const bool shape = t.shape && t.alike && t.shape->width != 0;
  const auto number = [](bool known, auto value) { return known ? Json(value) : Json(nullptr); };
  Json j;
  j["same"] = t.different == 0;
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
  j["not_compared"] = pair.others;
  return j;
}

/// The folder for heat maps and flip pictures, with its subfolders; those that are empty in the end are removed.
class Views {
 public:
  explicit Views(const std::string& path) : path_(path) {
    if (!path.empty()) folders_.emplace_back(path_);
  }

  void save(TempFiles& files, const std::string& name, const DiffViews& views) {
    const fs::path base = path_ / name;
    folders_.emplace_front(base.parent_path());
    if (views.heat.width != 0) save_image(files, fs::path(base) += ".heat.png", views.heat);
    save_flip(files, fs::path(base) += ".flip.png", views.a, views.b);
  }

 private:
  fs::path path_;
  std::list<OutFolder> folders_;
};

/// "3 files are no pictures and were not compared: a.json, b.txt and 1 more"
std::string other_files(const std::vector<std::string>& names) {
  if (names.empty()) return "";
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return fmt::format("not compared, no pictures: {}\n", text);
}

}  // namespace

int diff_two_folders(const DiffCommand& o) {
  const FolderPair pair = pair_folders(o.a, o.b);
  if (pair.pictures.empty()) throw Error(fmt::format("{} and {}: neither folder holds a picture", o.a, o.b));
  Views views(o.out);
  TempFiles files;
  JUnitWriter junit(files, o.junit, "kage diff");
  DiffOptions limits = o.limits;
  if (!o.mask.empty()) {
    const QuietStderr quiet;
    limits.mask = load_mask(o.mask);
  }
  Totals totals;
  std::string lines;
  Progress progress;
  for (const FolderEntry& entry : pair.pictures) {
    check_interrupt();
    progress.show(fmt::format("picture {}/{}: {}", totals.pictures + 1, pair.pictures.size(), entry.name));
    const Stopwatch watch;
    if (!entry.in_a || !entry.in_b) {
      const std::string text = fmt::format("different: only in {}", entry.in_a ? o.a : o.b);
      lines += fmt::format("{}: {}\n", entry.name, text);
      junit.fail(entry.name, watch.seconds(), text);
      totals.add_missing(entry);
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
    lines += fmt::format("{}: {}\n", entry.name, describe(r));
    junit.fail(entry.name, watch.seconds(), describe(r), details(r));
    if (!o.out.empty()) views.save(files, entry.name, seen);
  }
  progress.clear();
  junit.close();
  const bool same = totals.different == 0;
  lines += fmt::format("{}: {} compared", same ? "same" : "different", counted(totals.pictures, "picture"));
  if (!same) lines += fmt::format(", {} {}", totals.different, totals.different == 1 ? "differs" : "differ");
  if (totals.only_a != 0) lines += fmt::format(", {} only in {}", totals.only_a, o.a);
  if (totals.only_b != 0) lines += fmt::format(", {} only in {}", totals.only_b, o.b);
  lines += "\n" + other_files(pair.others);
  if (!o.out.empty() && totals.different > totals.only_a + totals.only_b)
    lines += fmt::format("heat maps and flip pictures: {}\n", o.out);
  finish(o, to_json(totals, pair), files, lines);
  return same ? kSame : kDifferent;
}

int bless_folder(const DiffCommand& o) {
  Progress progress;
  std::optional<QuietStderr> quiet(std::in_place);
  const std::vector<BlessEntry> plan = plan_bless(o.a, o.b, [&](const std::string& name) {
    check_interrupt();
    quiet.reset();
    progress.show(name);
    quiet.emplace();
  });
  quiet.reset();
  progress.clear();
  using What = BlessEntry::What;
  std::uint64_t count[4] = {};
  Json names[4] = {Json::array(), Json::array(), Json::array(), Json::array()};
  std::string lines;
  for (const BlessEntry& entry : plan) {
    const auto what = static_cast<std::size_t>(entry.what);
    ++count[what];
    names[what].push_back(entry.name);
    if (entry.what == What::changed) lines += fmt::format("changed: {}: {}\n", entry.name, entry.reason);
    if (entry.what == What::added) lines += fmt::format("added: {}\n", entry.name);
    if (entry.what == What::missing) lines += fmt::format("{}: {}\n", o.prune ? "removed" : "missing", entry.name);
  }
  const auto of = [&](What what) { return count[static_cast<std::size_t>(what)]; };
  const auto list = [&](What what) { return names[static_cast<std::size_t>(what)]; };
  const bool nothing = of(What::changed) + of(What::added) + of(What::missing) == 0;
  const bool same = nothing || (!o.dry_run && (o.prune || of(What::missing) == 0));

  Json j;
  j["same"] = same;
  j["dry_run"] = o.dry_run;
  j["unchanged"] = of(What::same);
  j["changed"] = list(What::changed);
  j["added"] = list(What::added);
  j["missing"] = o.prune ? Json::array() : list(What::missing);
  j["removed"] = o.prune ? list(What::missing) : Json::array();
  lines += fmt::format("{}{}: {} the same, {} changed, {} added, {} {}\n", o.b, o.dry_run ? " (nothing is done)" : "",
                       of(What::same), of(What::changed), of(What::added), of(What::missing),
                       o.prune ? "removed" : "missing");
  if (of(What::missing) != 0 && !o.prune)
    lines += fmt::format("what is missing in {} stays; --prune removes it\n", o.a);
  TempFiles files;
  const auto say = [&] { finish(o, j, files, lines); };
  if (o.dry_run)
    say();
  else
    bless(o.a, o.b, plan, o.prune, say);
  return same ? kSame : kDifferent;
}

}  // namespace kage::cli
