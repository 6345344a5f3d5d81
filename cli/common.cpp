// SPDX-License-Identifier: Apache-2.0
#include "common.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <set>

#include "kage/error.hpp"
#include "kage/geometry.hpp"
#include "kage/light.hpp"
#include "kage/scene.hpp"

namespace kage::cli {
namespace {

volatile std::sig_atomic_t signalled = 0;  // the number of the first signal

// The second one ends the program wherever it waits, destructors and exit handlers among that. What it leaves in hidden
// folders the next run removes, and its children die with it.
void on_signal(int number) {
  if (signalled != 0) _exit(kSignalled + number);
  signalled = number;
}

}  // namespace

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& what, const std::string& examples) {
  CLI::App* command = app.add_subcommand(name, what);
  command->footer("Examples:\n" + examples);
  return command;
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  return {[least, most](const std::string& text) {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, value);
            if (error != std::errc{} || stop != end || value < least || value > most)
              return fmt::format("{} is not a whole number from {} to {}", text, least,
                                 most == std::numeric_limits<std::uint64_t>::max() ? "2^64 - 1" : fmt::to_string(most));
            // CLI11 would take it for octal.
            return text.size() > 1 && text.front() == '0' ? text + " begins with 0" : std::string();
          },
          "", "whole"};
}

CLI::Validator real_number(double least, double most, const char* least_text) {
  return {[least, most, first = least_text != nullptr ? std::string(least_text) : fmt::format("{}", least)](
              const std::string& text) {
            const bool plain = text.find_first_not_of("0123456789.eE+-") == std::string::npos;
            char* stop = nullptr;
            const double value = plain ? std::strtod(text.c_str(), &stop) : 0;
            if (!plain || text.empty() || *stop != '\0') return text + " is not a number";
            return value >= least && value <= most ? std::string()
                                                   : text + fmt::format(" is not in {} .. {}", first, most);
          },
          "", "number"};
}

void option_size(CLI::App& command, Options& options) {
  command
      .add_option_function<std::string>(
          "--size",
          [&options](const std::string& text) {
            const char* const end = text.data() + text.size();
            Size size;
            const auto w = std::from_chars(text.data(), end, size.width);
            if (w.ec != std::errc{} || w.ptr == end || *w.ptr != 'x')
              throw CLI::ValidationError("--size", text + " is not WxH, like 640x480");
            const auto h = std::from_chars(w.ptr + 1, end, size.height);
            if (h.ec != std::errc{} || h.ptr != end)
              throw CLI::ValidationError("--size", text + " is not WxH, like 640x480");
            if (size.width < 1 || size.width > kMaxSize || size.height < 1 || size.height > kMaxSize)
              throw CLI::ValidationError("--size", fmt::format("{}: width and height are 1 .. {}", text, kMaxSize));
            options.size = size;
            options.size_given = true;
          },
          "picture size, default 640x480")
      ->type_name("WxH");
}

static void option_frames(CLI::App& command, Options& options) {
  command
      .add_option("--frames", options.frames,
                  "number of frames, spread over the animation or the camera path, default: the scene's own")
      ->check(whole_number(1, kMostFrames))
      ->type_name("N");
}

static void option_config(CLI::App& command, Options& options) {
  command
      .add_option("--config", options.config,
                  "the core's parameters: a name in rtl/configs.yaml or a YAML file of PARAMETER: value lines, "
                  "default: the first name that can draw it all")
      ->type_name("NAME|FILE");
}

void option_seed(CLI::App& command, Options& options) {
  command.add_option("--seed", options.seed, "seed of everything random, default 1")
      ->check(whole_number())
      ->type_name("S");
}

void option_json(CLI::App& command, Options& options) {
  command.add_option("--json", options.json, "write the result as JSON; - is standard output, with nothing else on it")
      ->type_name("FILE");
}

static std::string what_a_scene_is() {
  return fmt::format(
      "a built-in scene ({}), a mesh or scene file (glTF, or what else Assimp reads), a stream file, or, "
      "for cosim and explain, random frames (random, random:damaged, random:mixed)",
      fmt::join(builtin_scenes(), ", "));
}

void option_scene(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.input, what_a_scene_is())->required();
}

void option_scenes(CLI::App& command, std::vector<std::string>& inputs) {
  command.add_option("SCENE", inputs, "one or more, each " + what_a_scene_is())->required();
}

static void option_degrade(CLI::App& command, Options& options) {
  command.add_flag(
      "--degrade", options.degrade,
      "where the configuration lacks something, draw without it (no shadows, those of one light, hard ones; flat, grey "
      "or opaque instead of smooth, coloured or translucent) instead of refusing");
}

static void option_units_only(CLI::App& command, Options& options) {
  command.add_flag(
      "--units-only", options.units_only,
      "refuse a frame in which a convex polyhedron finds no expansion unit, instead of drawing it by spans");
}

static const std::map<std::string, TranslucentWay>& translucent_ways() {
  static const std::map<std::string, TranslucentWay> kWays{{"exact", TranslucentWay::exact},
                                                           {"centroid", TranslucentWay::centroid},
                                                           {"submission", TranslucentWay::submission}};
  return kWays;
}

std::string name_of(TranslucentWay way) {
  for (const auto& [name, value] : translucent_ways())
    if (value == way) return name;
  return {};
}

static void option_translucent(CLI::App& command, Options& options) {
  command
      .add_option_function<std::string>(
          "--order", [&options](const std::string& name) { options.order = translucent_ways().at(name); },
          "order of translucent faces, default exact; the others show what cheaper orders get wrong")
      ->option_text("exact|centroid|submission")
      ->check(CLI::IsMember({"exact", "centroid", "submission"}))
      ->type_name("WAY");
  command
      .add_option("--alpha", options.alpha,
                  "multiply the alpha of every material by A, 1/255 to 1; below 1 all is translucent")
      ->option_text("A")
      ->check(real_number(1.0 / 255, 1, "1/255"))
      ->type_name("A");
}

static void option_cull(CLI::App& command, Options& options) {
  command.add_flag("--cull", options.cull,
                   "leave out faces of single-sided materials that are turned away from the eye; they cast shadows all "
                   "the same");
}

static void option_lights(CLI::App& command, Options& options) {
  command
      .add_option("--samples", options.samples,
                  fmt::format("points that stand for a light that is no point itself: a disc, rectangle or sphere; "
                              "default {}",
                              options.samples))
      ->check(whole_number(1, kMaxSamples))
      ->type_name("N");
  command
      .add_option("--classes", options.classes,
                  fmt::format("normals that the table of several lights tells apart, spread evenly; default {}",
                              options.classes))
      ->check(whole_number(1, kMaxClasses))
      ->type_name("N");
}

void option_max_fragments(CLI::App& command, Options& options) {
  command
      .add_option(
          "--max-fragments", options.max_fragments,
          fmt::format("refuse a visibility order that would cut its faces into more than N fragments, default {} or "
                      "four times the faces, whichever is more: faces through one another are cut into more and more "
                      "(docs/order.md)",
                      OrderBuildOptions::kFragments))
      ->check(whole_number())
      ->type_name("N");
}

void option_threads(CLI::App& command, Options& options) {
  command.add_option("--threads", options.threads, "threads to use, default: one per processor")
      ->check(whole_number(1, 1024))
      ->type_name("N");
}

void option_outside(CLI::App& command, Options& options) {
  command.add_flag("--allow-outside", options.allow_outside,
                   "read files that a scene's file names (buffers, materials) wherever they lie, instead of refusing "
                   "those outside its folder");
}

void option_fault(CLI::App& command, std::string& fault) {
  command
      .add_option("--fault", fault, "build the RTL with a deliberate defect, to see it found: a patch of verif/faults")
      ->type_name("NAME");
}

void options_of_frames(CLI::App& command, Options& options) {
  option_size(command, options);
  option_frames(command, options);
  option_config(command, options);
  option_degrade(command, options);
  option_units_only(command, options);
  option_translucent(command, options);
  option_cull(command, options);
  option_max_fragments(command, options);
  option_lights(command, options);
  option_seed(command, options);
  option_threads(command, options);
  option_outside(command, options);
}

bool json_only(const Options& options) { return options.json == "-"; }

void check_json(const Options& options) {
  if (options.json.empty() || json_only(options)) return;
  TempFiles file;
  const OutputFile probe(file, options.json);
}

void finish(const Options& options, const Json& value, TempFiles& files, const std::string& text) {
  const std::string json = value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (!options.json.empty() && !json_only(options)) write_text(files, options.json, json);
  files.place();
  const std::string& said = json_only(options) ? json : text;
  if (!said.empty()) {
    const bool whole = std::fwrite(said.data(), 1, said.size(), stdout) == said.size() && std::fflush(stdout) == 0;
    if (!whole) throw Error("standard output: cannot be written");
  }
  files.settle();
}

void write_json(const Options& options, const Json& value, TempFiles& files) { finish(options, value, files, ""); }

void write_json(const Options& options, const Json& value) {
  TempFiles files;
  write_json(options, value, files);
}

OrderBuildOptions order_build(const Options& options) {
  OrderBuildOptions build;
  build.threads = options.threads;
  build.max_fragments = options.max_fragments;
  build.progress = [](double) { check_interrupt(); };
  return build;
}

OrderBuildOptions order_build(const Options& options, Progress& progress, const std::string& what) {
  OrderBuildOptions build = order_build(options);
  build.progress = [&progress, what](double done) {
    check_interrupt();
    progress.show(fmt::format("{}: {:.0f} %", what, std::floor(100 * done)));
  };
  return build;
}

void refuse_fragments(const std::string& where, const TooManyFragments& why) {
  throw Error(fmt::format("{}: {} (--max-fragments)", where, why.what()));
}

Json to_json(const Config& config) {
  Json object = Json::object();
  for (const ParamInfo& p : kParams) object[std::string(p.name)] = config.*(p.member);
  return object;
}

OutFolder::OutFolder(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code ec;
  std::vector<fs::path> missing;
  for (fs::path p = path; !p.empty() && !fs::exists(p, ec); p = p.parent_path()) missing.insert(missing.begin(), p);
  // One by one, so that a failure half-way leaves none: the destructor of a half-made object does not run.
  for (const fs::path& p : missing) {
    if (fs::create_directory(p, ec)) made_.insert(made_.begin(), p);
    if (ec) break;
  }
  if (ec || !fs::is_directory(path, ec)) {
    remove();
    throw Error(fmt::format("{}: the folder cannot be made: {}", path.string(), ec ? ec.message() : "not a folder"));
  }
  if (::access(path.c_str(), W_OK | X_OK) != 0) {
    const int error = errno;
    remove();
    throw Error(fmt::format("{}: cannot be written to: {}", path.string(), std::strerror(error)));
  }
}

OutFolder::~OutFolder() { remove(); }

void OutFolder::remove() {
  for (const std::filesystem::path& p : made_) (void)::rmdir(p.c_str());  // refuses one with something in it
  made_.clear();
}

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup = {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup's wish stands
  // A reader that has gone away, and a file larger than ulimit -f allows, are errors of the write: what is half done is
  // tidied up.
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGXFSZ, &action, nullptr);
}

void open_standard_files() {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd)
    if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", fd == STDIN_FILENO ? O_RDONLY : O_WRONLY) < 0) return;
}

void say(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

bool interrupted() { return signalled != 0; }

int interrupted_code() { return kSignalled + signalled; }

std::string gtkwave_line(const std::string& save_file) { return "gtkwave " + quoted(save_file); }

std::string quoted(const std::string& text) {
  const auto plain = [](char c) {
    return (std::isalnum(static_cast<unsigned char>(c)) != 0) ||
           std::string_view("_./,:=+-@%").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}

std::filesystem::path resolved(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ec;
  return fs::weakly_canonical(fs::absolute(path, ec), ec);
}

void refuse_twice(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> seen;
  for (const std::string& path : paths)
    if (!path.empty() && !seen.insert(resolved(path)).second)
      throw Error(fmt::format("{}: is to be written twice", path));
}

void check_interrupt() {
  if (interrupted()) throw Interrupted{};
}

Progress::Progress() {
  const char* term = std::getenv("TERM");
  terminal_ = isatty(STDERR_FILENO) != 0 && term != nullptr && std::string_view(term) != "dumb";
  const char* const seconds = std::getenv("KAGE_PROGRESS");
  if (seconds == nullptr) return;
  double value = 0;
  const char* const end = seconds + std::strlen(seconds);
  const auto [stop, error] = std::from_chars(seconds, end, value);
  if (error == std::errc{} && stop == end && value >= 0 && value < 1e9) pause_ = std::chrono::duration<double>(value);
}

Progress::~Progress() { clear(); }

void Progress::show(const std::string& text) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_) {
    if (pause_.count() == 0 || now - last_ < pause_) return;
    last_ = now;
    say(text + "\n");
    return;
  }
  if (shown_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  shown_ = true;
  winsize window{};
  const std::size_t columns =
      ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1 ? window.ws_col - 1U : 79U;
  say("\r\033[K" + text.substr(0, columns));
}

void Progress::clear() {
  if (!shown_) return;
  say("\r\033[K");
  shown_ = false;
}

}  // namespace kage::cli
