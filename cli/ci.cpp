// SPDX-License-Identifier: Apache-2.0
#include "ci.hpp"

#include <charconv>
#include <system_error>

#include "options.hpp"

namespace kage::cli {

void option_shard(Command command, cosim::Shard& shard, const std::string& what) {
  command
      .add_option_function<std::string>(
          "--shard",
          [&shard](const std::string& text) {
            const char* const end = text.data() + text.size();
            cosim::Shard s;
            s.given = true;
            const auto i = std::from_chars(text.data(), end, s.index);
            const bool slash = i.ec == std::errc{} && i.ptr != end && *i.ptr == '/';
            const auto n = slash ? std::from_chars(i.ptr + 1, end, s.count) : i;
            if (!slash || n.ec != std::errc{} || n.ptr != end || s.count < 1 || s.count > cosim::kMostFrames ||
                s.index < 1 || s.index > s.count)
              throw ValueError("--shard", text + " is not I/N with I from 1 to N, like 2/4");
            shard = s;
          },
          what)
      .type_name("I/N");
}

void option_junit(Command command, std::string& path, const std::string& each) {
  command.add_option("--junit", path, "write JUnit XML: a test case for each " + each).type_name("FILE");
}

void option_annotate(Command command, std::string& annotate) {
  command
      .add_option("--annotate", annotate,
                  "github: print a difference so that GitHub shows it at the RTL's file, default where GITHUB_ACTIONS "
                  "is true; none: never")
      .option_text("github|none")
      .check(one_of({"github", "none"}))
      .type_name("WHERE");
}

}  // namespace kage::cli
