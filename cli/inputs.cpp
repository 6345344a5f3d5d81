// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "kage/error.hpp"
#include "results.hpp"
#include "stimulus/random_frames.hpp"
#include "text.hpp"
#include "vectors/pack.hpp"

namespace kage::cli {

void refuse_pack(const std::string& input) {
  const std::filesystem::path folder(input);
  std::error_code e;
  if (std::filesystem::is_directory(folder, e) && std::filesystem::exists(folder / vectors::kManifest, e))
    throw Error(fmt::format(
        "{}: a folder of kage vectors is no scene: kage board plays it, kage vectors --check reads it", input));
}

void refuse_repeated(const std::vector<std::string>& inputs) {
  for (auto it = inputs.begin(); it != inputs.end(); ++it)
    if (std::find(inputs.begin(), it, *it) != it) throw Error(fmt::format("{}: given twice", *it));
}

void refuse_random(const std::string& input) {
  if (verif::random_manner(input))
    throw Error(fmt::format("{}: random frames are for kage cosim, kage explain and kage vectors", input));
}

std::string notes_text(const cosim::Source& source) {
  std::string text;
  for (const std::string& note : source.notes()) text += fmt::format("{}: {}\n", source.name(), shown(note));
  return text;
}

void print_notes(const cosim::Source& source, const std::string& json) {
  fmt::print(json_only(json) ? stderr : stdout, "{}", notes_text(source));
}

}  // namespace kage::cli
