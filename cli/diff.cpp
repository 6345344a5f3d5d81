// SPDX-License-Identifier: Apache-2.0
// kage diff A B: compares two pictures, folders of pictures or streams, or makes one folder like the other.
#include "diff.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "command.hpp"
#include "file/extension.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "options.hpp"
#include "results.hpp"

namespace kage::cli {
namespace {

namespace fs = std::filesystem;

enum class Sort { nothing, picture, folder, stream };

Sort sort_of(const fs::path& path) {
  std::error_code ec;
  const fs::file_status status = fs::status(path, ec);
  if (!fs::exists(status)) return Sort::nothing;
  if (fs::is_directory(status)) return Sort::folder;
  return is_stream_file(path) || lower_extension(path) == ".kage" ? Sort::stream : Sort::picture;
}

/// Whether the name says that it is a scene's, of which there is no picture yet.
bool is_scene_file(const fs::path& path) {
  static constexpr std::string_view kEndings[] = {".gltf", ".glb", ".obj", ".ply", ".stl", ".off"};
  return sort_of(path) == Sort::picture &&
         std::find(std::begin(kEndings), std::end(kEndings), lower_extension(path)) != std::end(kEndings);
}

/// Throws Error if one of the options is given that `what` does not take.
void refuse(const DiffCommand& o, const std::string& what, const std::vector<std::string>& options) {
  for (const std::string& name : o.given)
    if (std::find(options.begin(), options.end(), name) != options.end())
      throw Error(fmt::format("{} is not for {}; see kage diff --help", name, what));
}

int run(const DiffCommand& o) {
  Sort sort = sort_of(o.a);
  Sort other = sort_of(o.b);
  // A missing file is reported by the code that opens it.
  if (sort == Sort::nothing) sort = other;
  if (other == Sort::nothing) other = sort;
  static constexpr const char* kWords[] = {"nothing", "a file", "a directory", "a stream"};
  for (const std::string& name : {o.a, o.b})
    if (is_scene_file(name)) throw Error(fmt::format("{}: is a scene; kage render makes pictures of it", name));
  if (sort != other)
    throw Error(fmt::format("{}: is {}, and {} is {}: there is nothing to compare", o.b,
                            kWords[static_cast<std::size_t>(other)], o.a, kWords[static_cast<std::size_t>(sort)]));
  check_json(o, o.json);
  check_outputs(o);
  if (o.bless) {
    if (sort != Sort::folder) throw Error(fmt::format("{}: is no folder: --bless takes two", o.b));
    refuse(o, "--bless, which is exact",
           {"--lsb", "--abs", "--ulp", "--max-pixels", "--max-percent", "--region", "--mask", "--ignore-alpha",
            "--perceptual", "--max-memory", "--out", "--blink", "--part", "--junit"});
    return bless_folder(o);
  }
  refuse(o, "a comparison without --bless", {"--prune", "--dry-run"});
  if (sort == Sort::stream) {
    refuse(o, "streams, which are compared exactly",
           {"--lsb", "--abs", "--ulp", "--max-pixels", "--max-percent", "--region", "--mask", "--ignore-alpha",
            "--perceptual", "--max-memory", "--out", "--blink", "--part", "--exclude"});
    return diff_two_streams(o);
  }
  if (sort != Sort::folder) refuse(o, "two files", {"--exclude"});
  if (sort == Sort::folder) {
    refuse(o, "folders: --out FOLDER writes blink pictures too", {"--blink"});
    return diff_two_folders(o);
  }
  return diff_two_pictures(o);
}

/// "64x48+10+20": 64 wide, 48 high, from x 10, y 20.
Box parse_region(const std::string& text) {
  Box box;
  const char* at = text.data();
  const char* const end = at + text.size();
  static constexpr char kBehind[] = {'x', '+', '+', '\0'};
  std::size_t i = 0;
  for (int* const part : {&box.width, &box.height, &box.x, &box.y}) {
    const auto [stop, error] = std::from_chars(at, end, *part);
    const char behind = stop == end ? '\0' : *stop;
    if (error != std::errc{} || *part < 0 || behind != kBehind[i++])
      throw CLI::ValidationError("--region", text + " is not WxH+X+Y, like 64x48+10+20");
    at = stop + 1;
  }
  return box;
}

void add_thresholds(CLI::App& c, DiffOptions& limits) {
  c.add_option("--lsb", limits.lsb, "integers: the same if no further apart than N steps of the files' type")
      ->check(whole_number())
      ->type_name("N");
  CLI::Option* const abs = c.add_option("--abs", limits.abs, "floats: the same if no further apart than X")
                               ->check(real_number(0, std::numeric_limits<double>::max()))
                               ->type_name("X");
  c.add_option("--ulp", limits.ulp, "floats: the same if no further apart than N representable numbers")
      ->check(whole_number())
      ->type_name("N")
      ->excludes(abs);
  c.add_option("--max-pixels", limits.max_pixels, "same if at most N pixels differ, default 0")
      ->check(whole_number())
      ->type_name("N");
  c.add_option("--max-percent", limits.max_percent, "same if at most P percent of the compared pixels differ")
      ->check(real_number(0, 100))
      ->type_name("P");
  c.add_option_function<std::string>(
       "--region", [&limits](const std::string& text) { limits.region = parse_region(text); },
       "compare only the W x H pixels from column X, line Y")
      ->type_name("WxH+X+Y");
  c.add_flag("--ignore-alpha", limits.ignore_alpha, "do not compare the values of alpha");
  c.add_flag(
      "--perceptual", limits.perceptual,
      "say too how people see the difference: FLIP (mean and largest), and how many pixels OpenImageIO's perceptual "
      "measure tells apart; they decide nothing");
  c.add_option_function<std::uint64_t>(
       "--max-memory", [&limits](std::uint64_t mib) { limits.max_bytes = mib << 20U; },
       "refuse pictures that take more memory than so many MiB, default half of what there is")
      ->check(whole_number(1, 1 << 30))
      ->type_name("MIB");
  c.add_option("--part", limits.part,
               "of files that hold several pictures, as a multi-part EXR: the number of one, from 0")
      ->check(whole_number(0, std::numeric_limits<int>::max()))
      ->type_name("N");
}

}  // namespace

void add_diff(CLI::App& app, Action& action) {
  CLI::App* c =
      add_command(app, "diff", "Compare pictures, folders of pictures or streams, exactly unless told otherwise",
                  "  kage diff a.png b.png\n"
                  "  kage diff a.png b.png --lsb 1 --max-percent 0.01 --out heat.png --blink blink.png --json -\n"
                  "  kage diff a.exr b.exr --ulp 4 --region 64x48+10+20 --ignore-alpha\n"
                  "  kage diff reference/ out/ --out differences/ --junit diff.xml --exclude '*.fst'\n"
                  "  kage diff old.kage new.kage\n"
                  "  kage diff --bless --dry-run out/ reference/\n"
                  "  kage diff --bless out/ reference/\n"
                  "No option tolerates a NaN on either side, another size, channels, pixel type or colour space, or a\n"
                  "file that one folder lacks. docs/diff.md says what each option means.\n"
                  "Exit codes: 0 same, 1 different, 2 trouble. With --bless: 0 if B is like A now, 1 if it still\n"
                  "holds files that A lacks (or, with --dry-run, would be changed), 2 trouble: B is as it was.");
  const auto o = std::make_shared<DiffCommand>();
  c->add_option("A", o->a,
                "a picture (PNG, EXR, or what else docs/diff.md lets through), a folder of them, or a stream file")
      ->required();
  c->add_option("B", o->b, "another of the same sort")->required();
  add_thresholds(*c, o->limits);
  c->add_option("--mask", o->mask, "compare only pixels that are not 0 in this picture; its size is that of A and B")
      ->type_name("FILE");
  c->add_option(
       "--out", o->out,
       "write a heat map: A dimmed, red where they differ; of folders, a folder with heat maps and blink pictures "
       "of what differs")
      ->type_name("FILE|FOLDER");
  c->add_option("--blink,--flip", o->blink, "write a picture that shows A and B in turn, as animated PNG")
      ->type_name("FILE");
  c->add_option("--junit", o->junit, "write JUnit XML: a test case for each picture, or each frame of a stream")
      ->type_name("FILE");
  c->add_option("--exclude", o->exclude, "folders: leave out files whose name matches, as '*.fst'; may be repeated")
      ->type_name("GLOB")
      ->allow_extra_args(false);
  c->add_flag("--bless", o->bless,
              "make folder B like folder A: copy files that are new or differ, leave those that are the same");
  c->add_flag("--prune", o->prune, "with --bless: remove pictures and streams that A lacks from B");
  c->add_flag("--dry-run", o->dry_run, "with --bless: only say what would be done");
  option_json(*c, o->json);
  c->callback([o, c, &action] {
    for (const CLI::Option* option : c->get_options())
      if (option->count() > 0 && !option->get_lnames().empty()) o->given.push_back("--" + option->get_lnames().front());
    action = [o] { return run(*o); };
  });
}

}  // namespace kage::cli
