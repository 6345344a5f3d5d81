// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/old_evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "file/inputs.hpp"

namespace kage::cosim {

void remove_old_evidence(TempFiles& files, const std::string& folder, const std::string& name, bool random,
                         FrameSteps steps, const Report& r) {
  namespace fs = std::filesystem;
  if (folder.empty()) return;
  std::vector<std::string> ends{"_expected.png", "_actual.png", "_difference.png", ".fst", ".gtkw"};
  if (random) ends.insert(ends.end(), {".png", ".kage", "_ahead.kage"});
  for (int i = 0; i < r.frames; ++i)
    for (const std::string& end : ends) {
      const int frame = steps.first + i * steps.step;
      const auto& d = r.first_difference;
      if (d && d->frame == frame && end == kept_ending(*d)) continue;  // it is written anew
      const fs::path path = fs::path(folder) / fmt::format("{}_{:04}{}", name, frame, end);
      if (is_input(path)) continue;
      std::error_code ec;
      const fs::file_type type = fs::symlink_status(path, ec).type();
      if ((type == fs::file_type::regular || type == fs::file_type::symlink) &&  // else it was not ours
          std::find(r.pictures.begin(), r.pictures.end(), path.string()) == r.pictures.end())
        files.remove(path);
    }
}

}  // namespace kage::cosim
