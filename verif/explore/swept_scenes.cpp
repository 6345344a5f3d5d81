// SPDX-License-Identifier: Apache-2.0
#include "explore/swept_scenes.hpp"

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
#include "explore/synthesis.hpp"
#include "file/meant.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage::explore {
namespace {

Config config_of(const SweepOptions& o, const std::shared_ptr<const Scene>& scene, const DrawOptions& draw,
                 cosim::Host& host) {
  if (o.config.empty()) return choose_config(*scene, draw).config;
  if (o.config != cosim::kPlanned) return load_config(o.config).config;
  const cosim::SourceOptions& own = o;
  cosim::SourceOptions of = own;
  of.frames = draw.frames;
  return cosim::planned_config(of, scene, host).config;
}

SweepPoint base_of(const SweepOptions& o, const std::shared_ptr<const Scene>& scene, const DrawOptions& draw,
                   cosim::Host& host) {
  SweepPoint base;
  base.config = config_of(o, scene, draw, host);
  base.look = draw.look;
  base.look.fit = true;
  return with(base, "SIZE", fmt::format("{}x{}", draw.width, draw.height));
}

/// An axis as --axes has it. A slip in its name is told before all names are.
SweepAxis axis_of(const std::string& text) {
  const std::string name = text.substr(0, text.find('='));
  const std::vector<std::string> names = axis_names();
  std::string upper = name;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const std::string near = nearest(upper, names);
  if (!near.empty() && near != name)
    throw Error(fmt::format("--axes {}: there is no axis {}{}", text, name, meant(near)));
  return parse_axis(text);
}

void find_points(const SweepOptions& o, const SweepPoint& given, SweptScene& out) {
  SweepPoint base = given;
  base.axis = "base";
  base.value.clear();
  std::vector<SweepAxis> axes;
  for (const std::string& text : o.axes) add_axis(axes, axis_of(text));
  if (axes.empty()) {
    out.points = default_points(base, out.scene->needs());
  } else if (!o.grid) {
    out.points = alone(base, axes);
  } else {
    Grid grid = explore::grid(base, axes);
    out.points = std::move(grid.points);
    if (grid.left_out > 0)
      out.left_out =
          fmt::format("{} left out, because values exclude each other: {}",
                      counted(grid.left_out, "combination of --grid is", "combinations of --grid are"), grid.example);
  }
  if (is_soft(out)) out.points = with_seeds(std::move(out.points), o.seeds);
}

}  // namespace

bool is_soft(const SweptScene& s) { return s.scene->needs().samples > 1; }

int jobs_of(const SweepOptions& o) {
  return o.jobs > 0 ? o.jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Tools tools_of(const SweepOptions& o, cosim::Host& host) {
  Tools tools;
  const auto wait = [&host] { host.check(); };
  if (o.list) return tools;
  if (!o.no_area) tools.versions.yosys = yosys_version(wait);
  if (!o.no_cosim) tools.versions.model = fmt::format("{}", fmt::join(cosim::model_tools(), "\n"));
  if (!o.place.empty()) tools.placer = std::make_unique<Placer>(o.place, wait);
  return tools;
}

SweptScene open_swept(const SweepOptions& o, const Tools& tools, const std::string& input, cosim::Host& host,
                      cosim::Progress& progress, std::function<void(const std::string&)> doing) {
  const auto wait = [&host] { host.check(); };
  cosim::refuse_order_tree(input);
  if (is_stream_file(input)) throw Error(fmt::format("{}: a stream has its configuration already", input));
  auto scene = std::make_shared<const Scene>(cosim::load_scene(input, o, host));
  PlannedScene planned = cosim::planned_scene(o, scene, host, progress);
  if (planned.draw.frames == 0) planned.draw.frames = std::min(2, scene->frame_count());
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  planned.draw.threads = std::max(1, (o.threads > 0 ? o.threads : processors) / jobs_of(o));
  planned.draw.name = input;
  planned.draw.order.progress = [wait](double) { wait(); };
  const SweepPoint base = base_of(o, scene, planned.draw, host);
  SweptScene out;
  out.input = input;
  out.scene = std::make_unique<SweepScene>(std::move(scene), planned.draw, base, wait);
  find_points(o, base, out);
  out.runner = std::make_unique<SweepRunner>(*out.scene, out.points,
                                             SweepHow{.area = !o.no_area,
                                                      .cosim = !o.no_cosim,
                                                      .flip = !o.no_flip,
                                                      .tools = tools.versions,
                                                      .placer = tools.placer.get(),
                                                      .wait = wait,
                                                      .doing = std::move(doing)});
  return out;
}

}  // namespace kage::explore
