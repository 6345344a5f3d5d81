// SPDX-License-Identifier: Apache-2.0
#include "explore/kept_core.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "cosim/model/sha256.hpp"
#include "cosim/model/trust.hpp"
#include "file/read_file.hpp"
#include "file/temp_file.hpp"
#include "json/json_text.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::explore {

namespace fs = std::filesystem;

std::vector<fs::path> data_files(const char* folder, const char* extension) {
  const fs::path path = data_directory() / folder;
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path, error))
    if (entry.path().extension() == extension) found.push_back(entry.path());
  if (error) throw Error(fmt::format("{}: {}", path.string(), error.message()));
  std::sort(found.begin(), found.end());
  return found;
}

fs::path kept_core_file(const char* cache, const Config& config, const std::vector<std::string>& besides) {
  cosim::Sha256 hash;
  for (const std::string& text : besides) hash.add(text);
  for (const char* folder : {"rtl", "rtl/include", "rtl/include/generated"})
    for (const char* extension : {".sv", ".svh"})
      for (const fs::path& file : data_files(folder, extension)) {
        hash.add(file.filename().string());
        hash.add(read_file(file));
      }
  for (const ParamInfo& p : kParams) hash.add(static_cast<std::uint64_t>(config.*(p.member)));
  return cosim::cache_folder(cache) / (hash.take() + ".json");
}

void keep_core(const fs::path& path, const nlohmann::ordered_json& found) {
  TempFiles files;
  write_text(files, path.string(), json_text(found) + "\n");
  files.commit();
}

}  // namespace kage::explore
