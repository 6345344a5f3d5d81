// SPDX-License-Identifier: Apache-2.0

/// @file
/// Plans a core: the least configuration that draws given scenes within given limits of error and, if asked, keeps up
/// with a display, with the reason for each parameter. docs/plan.md has the inequalities.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kage/config.hpp"
#include "kage/pipeline.hpp"

namespace kage {

/// Where in the planned scenes something is.
struct PlanPlace {
  int scene = -1;  ///< its place in the list; -1: nowhere
  int frame = 0;   ///< of that scene
  int line = -1;   ///< from the top; -1: the whole frame
};

/// Largest errors that a picture may have.
struct PlanLimits {
  /// Error of a pixel's stored depth against the exact depth of its polygon's plane, as a share of the depth range.
  /// Default: a step of 24 bits.
  double z = 1.0 / ((1 << 24) - 3);
  /// Error of a pixel's colour against exact arithmetic, in steps of 8 bits: a whole number, at least 1. A colour next
  /// to the middle between two steps may fall to either side, however small the error.
  int color = 1;
  bool color_given = false;  ///< `color` is refused where no width keeps it; else the least that can be kept is taken
};

/// Which of several configurations that serve is taken.
enum class Prefer : std::uint8_t {
  speed,  ///< fewest clocks for all frames; of those within 1 % of the fewest, the fewest look-up tables
  area,   ///< fewest look-up tables, by the estimate; of those within 1 % of the fewest, the fewest clocks
  words,  ///< fewest words for all frames
};

/// How much more than the least counts as equal, as a share: of clocks with Prefer::speed, of look-up tables with
/// Prefer::area. Where the estimates of two measured cores are nearer than that, the one with the smaller estimate has
/// the larger count as often as the smaller (`tools/area`, docs/plan.md).
inline constexpr double kAsGood = 0.01;

/// A display that the core has to keep up with.
struct PlanClock {
  double mhz = 0;   ///< the core's clock
  double fps = 60;  ///< frames a second
  /// Lines in a frame's time, blanking included, of which there is a line at least; 0: usual_total_lines().
  int total_lines = 0;
};

/// Lines in a frame's time of a display, blanking included: 525 for 480 lines, 750 for 720, 1125 for 1080, 2250 for
/// 2160 (CEA-861); for others a sixteenth more than it shows, rounded up.
/// @param height lines that are shown
/// @return lines that a frame takes
int usual_total_lines(int height);

/// A scene and how it is drawn.
struct PlannedScene {
  std::shared_ptr<const Scene> scene;  ///< what is drawn
  DrawOptions draw;                    ///< how; frames 0: as many as the scene has
};

/// Why a parameter has its value.
struct PlanReason {
  std::string_view parameter;  ///< its name
  int value = 0;               ///< its value
  std::string text;            ///< one line: what asks for it, where, and what one less would break
};

/// How a plan is made.
struct PlanOptions {
  PlanLimits limits = {};                  ///< what may be wrong
  Prefer prefer = Prefer::area;            ///< which of several is taken
  std::optional<PlanClock> clock = {};     ///< what it has to keep up with
  bool front_end = false;                  ///< the core makes spans of polygons: ACTIVE has room for all at once
  std::function<void(double)> progress{};  ///< called with the share that is done; what it throws ends the plan
  /// Called for each way to draw shadows with the widths that the inequalities give, the finest where none satisfies
  /// them. It may put others in their place, with their reasons (kage plan --guarantee measured), that are legal and
  /// draw the scenes; that `limits` are kept is then up to it. It returns "", or, where no widths show light within the
  /// limit in this way, how far off it is: such a way is left out where another one keeps it.
  std::function<std::string(Config& widths, std::vector<PlanReason>& reasons)> lower{};
};

/// Cost of a configuration for the planned frames.
struct PlanCost {
  std::uint64_t words = 0;       ///< of all frames, at the span level
  std::uint64_t clocks = 0;      ///< of all frames, by design (docs/rtl.md, "Clocks"); behind a front end if it has one
  std::uint64_t worst_line = 0;  ///< clocks of the line that takes most
  PlanPlace worst_at;            ///< that line
  /// Clocks that a line of a display must have, the two lines of the way out used; with counters and translucency those
  /// of a FIFO behind the core (docs/plan.md, "The clock").
  double needed_line = 0;
  PlanPlace needed_at;              ///< the first of the lines that ask for it
  int needed_lines = 0;             ///< how many those are
  double luts = 0;                  ///< look-up tables of an ECP5, estimated
  double flip_flops = 0;            ///< estimated
  double luts_off = 0;              ///< how far the estimate of look-up tables is off, as a share, at most
  std::uint64_t ram_bits = 0;       ///< of its memories
  int bits_per_pixel = 0;           ///< of a pixel's state
  double golden_seconds = 0;        ///< wall time that the golden core took for all frames; differs from run to run
  std::optional<bool> meets_clock;  ///< whether it keeps up with the display; none if no clock was given
};

/// A configuration that serves.
struct PlanCandidate {
  std::string way;  ///< "parity", "counting, 4 bits", "parity, 5 units"
  Config config;    ///< legal
  PlanCost cost;    ///< of the planned frames
};

/// A plan.
struct Plan {
  Config config;                      ///< what was chosen
  std::vector<PlanReason> reasons;    ///< in the order of the definition file; without units, none of theirs
  PlanCost cost;                      ///< of `config`
  std::vector<PlanCandidate> others;  ///< of each other way the configuration that would have been taken
  PlanCandidate smallest;             ///< the one that `area` takes: what speed costs more stands against it
  /// The one with the fewest clocks (`speed`) or look-up tables (`area`), if another one, within 1 % of it, was taken.
  std::optional<PlanCandidate> least;
  std::uint64_t pixels = 0;            ///< of all planned frames
  int frames = 0;                      ///< of all scenes
  std::array<int, 2> size{};           ///< width and height of the largest picture
  PlanLimits limits;                   ///< as kept
  double z_error = 0;                  ///< bound of the depth's error with `config`, as a share of the range
  std::uint64_t polygon_words = 0;     ///< with a front end: of all frames, at the polygon level
  std::optional<double> display_line;  ///< clocks that a line of the display has; none if no clock was given
};

/// Plans. Every frame is made once for each way to draw shadows, and once more to be costed; so the time is a few times
/// that of the front end. Throws Error that names the limit that no configuration keeps, the light that no core has
/// room for, or a frame that cannot be made.
/// @param scenes at least one
/// @param options what is asked
/// @return the plan
Plan make_plan(std::span<const PlannedScene> scenes, const PlanOptions& options);

/// Writes a plan as load_config() reads it.
/// @param plan what is written
/// @return YAML, one parameter a line, its reason behind it as a comment
std::string to_yaml(const Plan& plan);

}  // namespace kage
