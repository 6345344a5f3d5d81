// SPDX-License-Identifier: Apache-2.0
// kage-import VERSION PARENT SECONDS MIB FILE NAME OUTSIDE: reads the file of a scene, and gives it to the program that
// started it (scene/child.hpp). It is of use to nobody else.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "plugin/plugin.hpp"
#include "scene/answer.hpp"
#include "scene/import.hpp"
#include "scene/wire.hpp"

int main(int argc, char** argv) {
  if (argc != 8) {
    std::fputs("kage-import reads files of scenes for other programs of kage\n", stderr);
    return 2;
  }
  if (std::string_view(argv[1]) != kage::kPluginVersion) return kage::scene::kOtherVersion;
  const kage::scene::ImportLimits limits{std::atoi(argv[3]), std::atoll(argv[4])};
  const std::string name = argv[6];
  kage::scene::answer(std::atoi(argv[2]), name, limits, [&] {
    return kage::scene::packed(kage::scene::import_file(argv[5], name, std::string_view(argv[7]) == "1"));
  });
}
