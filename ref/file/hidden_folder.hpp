// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

namespace kage {

/// A folder `.kage-PID` for files that are not whole yet. It lies in the folder in which they will get their names, so
/// that a rename is enough, and goes with the object, with all that is left in it.
///
/// A process that is killed leaves it. Therefore every live process holds a lock on the file `.gitignore` in its hidden
/// folder, and whoever makes a hidden folder first removes those beside it whose lock nobody holds. The kernel releases
/// the lock of a dead process, whatever has its number by then. That file holds `*`, so that git adds no leftover, and
/// a comment by which a sweep knows that the folder is one of these: other folders of such a name stay.
class HiddenFolder {
 public:
  /// Makes one in `parent`, which must be there. Throws std::system_error if it cannot.
  explicit HiddenFolder(const std::filesystem::path& parent);
  ~HiddenFolder();
  HiddenFolder(const HiddenFolder&) = delete;
  HiddenFolder& operator=(const HiddenFolder&) = delete;

  /// The one that this process has in `parent` already, or a new one. Threads may share it.
  static std::shared_ptr<HiddenFolder> in(const std::filesystem::path& parent);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// A name in the folder that no other call returns, with this extension.
  [[nodiscard]] std::filesystem::path new_name(const std::filesystem::path& extension) const;

  /// Removes the hidden folders in `parent` whose processes have died. One that cannot be removed stays.
  static void sweep(const std::filesystem::path& parent);

  /// Whether a folder of this name is one of kage's.
  static bool is_name(std::string_view name);

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace kage
