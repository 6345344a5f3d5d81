// SPDX-License-Identifier: Apache-2.0
#include "sweep_scenes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <thread>
#include <utility>

#include "cosim/model/model.hpp"
#include "cosim/session/order_build.hpp"
#include "cosim/session/planned.hpp"
#include "cosim/session/source.hpp"
#include "file/meant.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "text.hpp"
#include "trade/synthesis.hpp"
#include "usage.hpp"

namespace kage::cli {
namespace {

using trade::SweepPoint;

// What --place is without a device, and the device that it means: of the family whose cells are counted.
constexpr const char* kPlaceFlag = "true";
constexpr const char* kPlaceDevice = "ecp5-85f";

Config config_of(const SweepCommand& o, const std::shared_ptr<const Scene>& scene, const DrawOptions& draw) {
  if (o.config.empty()) return choose_config(*scene, draw).config;
  if (o.config != cosim::kPlanned) return load_config(o.config).config;
  Options of = static_cast<const Options&>(o);
  of.frames = draw.frames;
  return cosim::planned_config(of, scene, terminal()).config;
}

SweepPoint base_of(const SweepCommand& o, const std::shared_ptr<const Scene>& scene, const DrawOptions& draw) {
  SweepPoint base;
  base.config = config_of(o, scene, draw);
  base.look = draw.look;
  base.look.fit = true;
  return trade::with(base, "SIZE", fmt::format("{}x{}", draw.width, draw.height));
}

/// An axis as --axes has it. A slip in its name is told before all names are.
trade::SweepAxis axis_of(const std::string& text) {
  const std::string name = text.substr(0, text.find('='));
  const std::vector<std::string> names = trade::axis_names();
  std::string upper = name;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const std::string near = nearest(upper, names);
  if (!near.empty() && near != name)
    throw Error(fmt::format("--axes {}: there is no axis {}{}", text, name, meant(near)));
  return trade::parse_axis(text);
}

void find_points(const SweepCommand& o, const SweepPoint& given, SweptScene& out) {
  SweepPoint base = given;
  base.axis = "base";
  base.value.clear();
  std::vector<trade::SweepAxis> axes;
  for (const std::string& text : o.axes) trade::add_axis(axes, axis_of(text));
  if (axes.empty()) {
    out.points = trade::default_points(base, out.scene->needs());
  } else if (!o.grid) {
    out.points = trade::alone(base, axes);
  } else {
    trade::Grid grid = trade::grid(base, axes);
    out.points = std::move(grid.points);
    if (grid.left_out > 0)
      out.left_out =
          fmt::format("{} left out, because values exclude each other: {}",
                      counted(grid.left_out, "combination of --grid is", "combinations of --grid are"), grid.example);
  }
  if (is_soft(out)) out.points = trade::with_seeds(std::move(out.points), o.seeds);
}

}  // namespace

bool is_soft(const SweptScene& s) { return s.scene->needs().samples > 1; }

int jobs_of(const SweepCommand& o) {
  return o.jobs > 0 ? o.jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Tools tools_of(const SweepCommand& o) {
  Tools tools;
  if (o.list) return tools;
  if (!o.no_area) tools.versions.yosys = trade::yosys_version(check_interrupt);
  if (!o.no_cosim) tools.versions.model = fmt::format("{}", fmt::join(cosim::model_tools(), "\n"));
  if (!o.place.empty())
    tools.placer = std::make_unique<trade::Placer>(o.place == kPlaceFlag ? kPlaceDevice : o.place, check_interrupt);
  return tools;
}

SweptScene open_swept(const SweepCommand& o, const Tools& tools, const std::string& input, Progress& progress,
                      std::function<void(const std::string&)> doing) {
  refuse_random(input);
  cosim::refuse_order_tree(input);
  if (is_stream_file(input)) throw Error(fmt::format("{}: a stream has its configuration already", input));
  auto scene = std::make_shared<const Scene>(cosim::load_scene(input, o, terminal()));
  PlannedScene planned = cosim::planned_scene(o, scene, terminal(), progress);
  if (planned.draw.frames == 0) planned.draw.frames = std::min(2, scene->frame_count());
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  planned.draw.threads = std::max(1, (o.threads > 0 ? o.threads : processors) / jobs_of(o));
  planned.draw.name = input;
  planned.draw.order.progress = [](double) { check_interrupt(); };
  const SweepPoint base = base_of(o, scene, planned.draw);
  SweptScene out;
  out.input = input;
  out.scene = std::make_unique<trade::SweepScene>(std::move(scene), planned.draw, base, check_interrupt);
  find_points(o, base, out);
  out.runner = std::make_unique<trade::SweepRunner>(*out.scene, out.points,
                                                    trade::SweepHow{.area = !o.no_area,
                                                                    .cosim = !o.no_cosim,
                                                                    .flip = !o.no_flip,
                                                                    .tools = tools.versions,
                                                                    .placer = tools.placer.get(),
                                                                    .wait = check_interrupt,
                                                                    .doing = std::move(doing)});
  return out;
}

}  // namespace kage::cli
