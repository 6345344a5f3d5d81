// SPDX-License-Identifier: Apache-2.0
#include "kage/bless.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "file/real_path.hpp"
#include "file/temp_file.hpp"
#include "kage/error.hpp"
#include "kage/stream_diff.hpp"

namespace kage {
namespace {

namespace fs = std::filesystem;
using What = BlessEntry::What;
using Sort = FolderEntry::Sort;

/// Folders that are made for new pictures, and unmade unless keep() says that there are pictures in them.
class MadeFolders {
 public:
  MadeFolders() = default;
  ~MadeFolders() {
    std::error_code ec;
    for (const fs::path& folder : made_) fs::remove(folder, ec);
  }
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;

  void make(const fs::path& folder) {
    std::error_code ec;
    if (folder.empty() || fs::is_directory(folder, ec)) return;
    if (fs::is_symlink(folder, ec) && !fs::exists(folder, ec))
      throw Error(fmt::format("{}: a link to nowhere", folder.string()));
    make(folder.parent_path());
    if (!fs::create_directory(folder, ec) || ec)
      throw Error(fmt::format("{}: the folder cannot be made: {}", folder.string(), ec ? ec.message() : "it exists"));
    made_.insert(made_.begin(), folder);
  }
  void keep() { made_.clear(); }

 private:
  std::vector<fs::path> made_;  // the innermost first
};

/// Refuses what would make --bless write to NEW, or to what is not in REFERENCE: folders that hold each other, and
/// links.
void check_apart(const fs::path& fresh, const fs::path& reference, const std::vector<FolderEntry>& entries) {
  const fs::path from = fs::canonical(fresh);
  const fs::path to = fs::canonical(reference);
  if (from == to) throw Error(fmt::format("{} and {}: are one folder", fresh.string(), reference.string()));
  if (lies_in(from, to)) throw Error(fmt::format("{}: lies in {}", fresh.string(), reference.string()));
  if (lies_in(to, from)) throw Error(fmt::format("{}: lies in {}", reference.string(), fresh.string()));
  for (const FolderEntry& entry : entries) {
    std::error_code ec;
    const fs::path target = reference / entry.name;
    const bool touched = entry.in_a || entry.sort != Sort::other;
    if (touched && fs::is_symlink(target, ec))
      throw Error(fmt::format("{}: is a link, and what it leads to is not written over", target.string()));
    if (entry.in_a && lies_in(real_path(fresh / entry.name), to))
      throw Error(fmt::format("{}: leads into {}", (fresh / entry.name).string(), reference.string()));
  }
}

/// Why the two are not the same; empty if they are.
std::string reason_of(const fs::path& a, const fs::path& b, Sort sort) {
  if (sort == Sort::picture) return diff_files(a, b).reason;
  if (sort == Sort::stream) return diff_streams(StreamFile(a), StreamFile(b)).reason;
  return diff_bytes(a, b);
}

/// Throws Error unless a new file is sound: a NaN in a reference would fail every later comparison with it.
void check_fresh(const fs::path& path, Sort sort) {
  if (sort != Sort::picture) {
    (void)reason_of(path, path, sort);  // reads it to the end
    return;
  }
  const DiffResult self = diff_files(path, path);
  if (self.nan_pixels != 0)
    throw Error(fmt::format("{}: {}: a picture with a NaN is never the same as a reference, so it cannot become one",
                            path.string(), self.reason));
}

}  // namespace

std::vector<BlessEntry> plan_bless(const fs::path& fresh, const fs::path& reference,
                                   const std::function<void(const std::string& name)>& each,
                                   const std::vector<std::string>& exclude) {
  const FolderPair pair = pair_folders(fresh, reference, exclude);
  check_apart(fresh, reference, pair.files);
  std::vector<BlessEntry> plan;
  bool any = false;
  for (const FolderEntry& entry : pair.files) {
    if (each) each(entry.name);
    BlessEntry& planned = plan.emplace_back(BlessEntry{entry.name, What::missing, "", entry.sort});
    if (!entry.in_a) continue;
    any = true;
    check_fresh(fresh / entry.name, entry.sort);
    if (!entry.in_b) {
      planned.what = What::added;
      continue;
    }
    try {
      planned.reason = reason_of(fresh / entry.name, reference / entry.name, entry.sort);
      planned.what = planned.reason.empty() ? What::same : What::changed;
    } catch (const Error& e) {
      planned.what = What::changed;
      planned.reason = e.what();
    }
  }
  if (!any) throw Error(fmt::format("{}: holds no file to take over", fresh.string()));
  return plan;
}

void bless(const fs::path& fresh, const fs::path& reference, const std::vector<BlessEntry>& plan, bool prune,
           const std::function<void()>& done) {
  MadeFolders folders;
  TempFiles files;
  for (const BlessEntry& entry : plan) {
    const fs::path target = reference / entry.name;
    if (prune && entry.prunable()) files.remove(target);
    if (entry.what != What::changed && entry.what != What::added) continue;
    folders.make(target.parent_path());
    OutputFile out(files, target);
    out.copy(fresh / entry.name);
    out.close();
  }
  files.place();
  if (done) done();
  files.settle();
  folders.keep();
}

}  // namespace kage
