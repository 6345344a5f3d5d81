// SPDX-License-Identifier: Apache-2.0
//
// What the subcommands share: options, results as JSON, progress, interruption. A subcommand parses, calls the library
// and prints.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "files/temp_file.hpp"
#include "kage/defs.hpp"
#include "kage/geometry.hpp"
#include "kage/order.hpp"

namespace kage::cli {

using Json = nlohmann::ordered_json;

class Progress;

/// Exit codes.
inline constexpr int kSame = 0;
inline constexpr int kDifferent = 1;
inline constexpr int kTrouble = 2;
inline constexpr int kSignalled = 128;  // and the signal's number, as shells have it

/// What a subcommand does once the command line is parsed; returns the exit code.
using Action = std::function<int()>;

// One function per subcommand: adds it to `app`; when it is given, `action` becomes what it does.
void add_cosim(CLI::App& app, Action& action);
void add_render(CLI::App& app, Action& action);
void add_stream(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_explain(CLI::App& app, Action& action);
void add_diff(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_regress(CLI::App& app, Action& action);
void add_model(CLI::App& app, Action& action);
void add_order(CLI::App& app, Action& action);
void add_cache(CLI::App& app, Action& action);
void add_list(CLI::App& app, Action& action);
void add_help(CLI::App& app, Action& action);

/// Adds a subcommand whose help ends with `examples`.
CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& what, const std::string& examples);

/// What writes --help: lines that are too long go on under where their text began.
std::shared_ptr<CLI::Formatter> help_formatter();

/// What is wrong with a command line that `app` refused, and the help to read: one line.
std::string explain(const CLI::App& app, const CLI::ParseError& error);

/// An argument or option of the command that was given as an empty text, as a script's variable that is not set makes
/// it: one line that names it. Empty if there is none.
std::string empty_value(const CLI::App& app);

/// A whole number from `least` to `most`, in decimal. As text: of CLI11's own numbers 010 is 8, and a minus sign or too
/// many digits wrap round in an unsigned one.
CLI::Validator whole_number(std::uint64_t least = 0, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// "rendr: no such command (did you mean render?)".
std::string no_such_command(const CLI::App& app, const std::string& name);

/// A number from `least` to `most`, written as people write it: strtod() would take nan, inf and hexadecimal. Messages
/// call the least one `least_text`, where that is given.
CLI::Validator real_number(double least, double most, const char* least_text = nullptr);

/// The most frames of a run, and the most shards.
inline constexpr int kMostFrames = 1000000;

/// A picture's size, "640x480".
struct Size {
  int width = 640;
  int height = 480;
};

/// Options that several subcommands have, and what they default to.
struct Options {
  std::string input;
  Size size;
  bool size_given = false;
  int frames = 0;  ///< 0: as many as the scene has
  std::string config;
  std::uint64_t seed = 1;
  std::string out;
  std::string json;
  int threads = 0;  ///< 0: one per processor
  bool degrade = false;
  bool units_only = false;  ///< polyhedra that find no unit are an error
  TranslucentWay order = TranslucentWay::exact;
  double alpha = 1;
  bool cull = false;           ///< faces are not drawn if the eye sees the side that their material does not show
  bool allow_outside = false;  ///< files that a scene's file names may lie outside its folder
  std::optional<std::uint64_t> max_fragments;  ///< that the order of translucent faces may cut; none: order.hpp's
  int samples = Look{}.samples;                ///< of a light that is no point
  int classes = Look{}.classes;                ///< of normals
};

/// As --order has it.
std::string name_of(TranslucentWay way);

/// What every command that makes frames takes: --size, --frames, --config, --degrade, --units-only, --order, --alpha,
/// --cull, --max-fragments, --samples, --classes, --seed, --threads, --allow-outside.
void options_of_frames(CLI::App& command, Options& options);
void option_max_fragments(CLI::App& command, Options& options);
void option_seed(CLI::App& command, Options& options);
void option_json(CLI::App& command, Options& options);
void option_scene(CLI::App& command, Options& options);                   // SCENE, a positional
void option_scenes(CLI::App& command, std::vector<std::string>& inputs);  // one or more of them
void option_threads(CLI::App& command, Options& options);
void option_size(CLI::App& command, Options& options);
void option_outside(CLI::App& command, Options& options);  // --allow-outside
void option_fault(CLI::App& command, std::string& fault);

/// Whether `--json -` claims standard output for itself.
bool json_only(const Options& options);

/// Throws Error if what --json names cannot be written: before the work, not after it.
void check_json(const Options& options);

/// Ends a run: writes `value` where --json says, if it was given, gives all of `files` their names, and prints `text`
/// unless JSON has standard output. All appear or none: if standard output fails, files are as they were.
void finish(const Options& options, const Json& value, TempFiles& files, const std::string& text);

/// The same for a run that prints on its own.
void write_json(const Options& options, const Json& value, TempFiles& files);
void write_json(const Options& options, const Json& value);

/// The parameters as an object, in the order of the definition file.
Json to_json(const Config& config);

/// How a visibility order is built as the options say. Building it shows `what` with how much is done, in percent, and
/// can be interrupted. `progress` must outlive the result.
OrderBuildOptions order_build(const Options& options, Progress& progress, const std::string& what);
OrderBuildOptions order_build(const Options& options);  // without a word

/// Why an order was refused, `where` being the file, and the frame of it: an Error in one line that names the option.
[[noreturn]] void refuse_fragments(const std::string& where, const TooManyFragments& why);

/// A folder for what a run writes, made with those above it. What was made and is empty in the end is removed again, so
/// that a run that fails leaves nothing.
class OutFolder {
 public:
  /// Throws Error if the folder cannot be made or written to.
  explicit OutFolder(const std::filesystem::path& path);
  ~OutFolder();
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;

 private:
  void remove();
  std::vector<std::filesystem::path> made_;  // the innermost first
};

/// `text` as a shell reads it back.
std::string quoted(const std::string& text);

/// The command line that shows a waveform by its save file.
std::string gtkwave_line(const std::string& save_file);

/// The same for all names of a file, links too; empty if there can be no such file.
std::filesystem::path resolved(const std::string& path);

/// Throws Error if two of the files that are to be written, by whatever name, are one. Empty paths are none.
void refuse_twice(const std::vector<std::string>& paths);

/// "1 frame", "2 frames".
template <std::integral Count>
std::string counted(Count count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// ", 3 segments" for a line that tells spans; nothing where there are none, as in a core without units.
inline std::string and_segments(std::uint64_t segments) {
  return segments == 0 ? std::string() : ", " + counted(segments, "segment");
}

/// Opens those of standard input, output and error that are closed on /dev/null: else a file of results would get their
/// number, and with it what is meant for a person.
void open_standard_files();

/// Writes to standard error. Where that cannot be, nobody is there to be told.
void say(const std::string& text);

/// Ctrl-C (SIGINT), SIGTERM and SIGHUP set a flag; loops ask it, so that files are whole or absent. A second one ends
/// the program at once. A pipe without reader and a file that is too large are errors of the write.
void catch_signals();
bool interrupted();

/// The exit code after such a signal: 130 for SIGINT, 143 for SIGTERM, 129 for SIGHUP.
int interrupted_code();

/// Thrown by check_interrupt() when the flag is set.
struct Interrupted {};
void check_interrupt();

/// How far work has come, on standard error: on a terminal a line that is written over and over; in a pipe, a file or
/// on a dumb terminal a line every ten seconds, so none where the work does not last. $KAGE_PROGRESS is another number
/// of seconds, 0: no lines.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const std::string& text);
  void clear();

 private:
  bool terminal_ = false;
  bool shown_ = false;
  std::chrono::duration<double> pause_{10};  // between lines where there is no terminal
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace kage::cli
