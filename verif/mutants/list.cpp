// SPDX-License-Identifier: Apache-2.0
#include "mutants/list.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "kage/error.hpp"

namespace kage::verif {

std::vector<Mutant> load_mutants(const std::filesystem::path& file) {
  std::vector<Mutant> all;
  try {
    for (const YAML::Node& node : YAML::LoadFile(file.string())) {
      const auto text = [&node](const char* key) { return node[key] ? node[key].as<std::string>() : std::string(); };
      Mutant m;
      m.number = static_cast<int>(all.size()) + 1;
      m.name = text("name");
      m.file = text("file");
      m.kind = text("class");
      m.breaks = text("breaks");
      m.module = text("seen_by");
      if (m.module.empty()) m.module = std::filesystem::path(m.file).stem().string();
      m.equivalent = text("equivalent");
      m.lives = text("lives");
      m.named = text("named");
      if (node["configs"]) m.configs = node["configs"].as<std::vector<std::string>>();
      if (m.name.empty() || m.file.empty() || m.kind.empty() || m.breaks.empty())
        throw Error(fmt::format("{}: mutant {} lacks name, file, class or breaks", file.string(), m.number));
      if (static_cast<int>(!m.equivalent.empty()) + static_cast<int>(!m.lives.empty()) +
              static_cast<int>(!m.named.empty()) >
          1)
        throw Error(fmt::format("{}: mutant {}: more than one of equivalent, lives and named", file.string(), m.name));
      if (std::any_of(all.begin(), all.end(), [&m](const Mutant& o) { return o.name == m.name; }))
        throw Error(fmt::format("{}: two mutants {}", file.string(), m.name));
      all.push_back(std::move(m));
    }
  } catch (const YAML::Exception& e) {
    throw Error(fmt::format("{}: {}", file.string(), e.what()));
  }
  return all;
}

}  // namespace kage::verif
