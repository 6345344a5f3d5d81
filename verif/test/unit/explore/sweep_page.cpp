// SPDX-License-Identifier: Apache-2.0
// The page of a sweep is held to a size: it has fewer pictures, then fewer rows, says so, and is the same each time.
#include "explore/sweep_page.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "cosim/report/run_record.hpp"
#include "explore/sweep_run.hpp"
#include "file/read_file.hpp"
#include "kage/pipeline.hpp"
#include "test/support/catch.hpp"
#include "test/support/pictures.hpp"

using namespace kage;
using namespace kage::explore;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kRows = 40;
constexpr int kFrames = 40;

/// A sweep of many rows that are measured once: all are the base's, under names of their own; every tenth has a star.
class Rows {
 public:
  Rows() {
    const auto loaded = std::make_shared<const Scene>(Scene::load("courtyard"));
    const DrawOptions draw{.width = 32, .height = 24, .frames = kFrames, .threads = 1, .name = "courtyard"};
    point_.config = choose_config(*loaded, draw).config;
    point_.look.fit = true;
    point_ = with(point_, "SIZE", "32x24");
    scene_ = std::make_unique<SweepScene>(loaded, draw, point_, [] {});
    SweepHow how{.area = false, .cosim = false, .flip = false, .wait = [] {}, .doing = [](const std::string&) {}};
    SweepRunner runner(*scene_, {point_}, how);
    const Json measured = runner.run(0, runner.words(0));
    for (int i = 0; i < kRows; ++i) {
      Json row;
      row["scene"] = "courtyard";
      row["axis"] = i == 7 ? "base" : "LANES";
      row["value"] = i == 7 ? "" : std::to_string(i);
      row["frames"] = kFrames;
      row["look"] = {{"width", 32}, {"height", 24}};
      row["config"] = report::to_json(point_.config);
      for (const char* key : {"accuracy", "speed", "area"}) row[key] = measured.at(key);
      row["area"]["luts"] = 1000 + i;
      row["pareto"] = i % 10 == 9;
      page_.rows.push_back({row, &point_, scene_.get(), "kage render courtyard"});
    }
    page_.command = "kage sweep courtyard --store s.sqlite --resume";
    page_.store = "s.sqlite";
    page_.doing = [](const std::string&) {};
  }

  /// Writes the page, and returns its text.
  std::string write(const std::filesystem::path& folder, std::size_t most_bytes) {
    page_.most_bytes = most_bytes;
    std::filesystem::create_directories(folder / kPicturesFolder);
    TempFiles files;
    write_sweep_page(files, folder, page_);
    files.commit();
    return read_file(folder / kPageName);
  }

 private:
  SweepPoint point_;
  std::unique_ptr<SweepScene> scene_;
  SweepPage page_;
};

Json data_of(const std::string& page) {
  const std::string begin = "id=\"data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return Json::parse(page.substr(at, page.find("</script>", at) - at));
}

/// The pictures that a page names are in the folder, and no other is.
void check_pictures(const Json& data, const std::filesystem::path& folder) {
  std::set<std::string> named;
  for (const Json& more : data.at("more"))
    for (const Json& p : more.at("pictures")) {
      named.insert(p.at("picture").get<std::string>());
      if (!p.at("map").is_null()) named.insert(p.at("map").get<std::string>());
    }
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(folder / kPicturesFolder))
    there.insert(std::string(kPicturesFolder) + "/" + entry.path().filename().string());
  CHECK(named == there);
}

}  // namespace

TEST_CASE("a page is no larger than it may be, and says what it lacks") {
  Rows rows;
  const verif::TempFolder folder("sweep-page");
  const std::string all = rows.write(folder.path, report::kPageBytes);
  const Json whole = data_of(all);
  CHECK(whole.at("left_out").get<std::string>().empty());
  CHECK(whole.at("rows").size() == kRows);
  CHECK(whole.at("more")[3].at("pictures").size() == kFrames);
  check_pictures(whole, folder.path);

  // Somewhat too large: the first frame's pictures alone.
  const std::string fewer = rows.write(folder.path, all.size() - 1000);
  const Json first = data_of(fewer);
  CHECK(fewer.size() < all.size() - 1000);
  CHECK(first.at("rows") == whole.at("rows"));
  for (const Json& more : first.at("more")) CHECK(more.at("pictures").size() == 1);
  CHECK_THAT(first.at("left_out").get<std::string>(), Catch::Matchers::ContainsSubstring("those of the first frame"));
  check_pictures(first, folder.path);

  // Far too large: the base, rows with a star, and as many others as there is room for, in their order.
  const std::size_t most = fewer.size() - (fewer.size() - all.find("id=\"data\">")) / 2;
  const std::string few = rows.write(folder.path, most);
  const Json some = data_of(few);
  CHECK(few.size() <= most);
  CHECK(few.size() > most - 30000);  // no row that there is room for is left out
  REQUIRE(some.at("rows").size() > 5);
  REQUIRE(some.at("rows").size() < kRows);
  std::size_t stars = 0;
  std::vector<int> luts;
  for (const Json& row : some.at("rows")) {
    stars += row.at("pareto").get<bool>() ? 1 : 0;
    luts.push_back(row.at("area").at("luts").get<int>());
  }
  CHECK(stars == kRows / 10);
  CHECK(std::is_sorted(luts.begin(), luts.end()));
  CHECK(std::count(luts.begin(), luts.end(), 1007) == 1);
  CHECK(some.at("groups")[0].at("rows").size() == some.at("rows").size());
  CHECK_THAT(some.at("left_out").get<std::string>(),
             Catch::Matchers::ContainsSubstring("Shown are " + std::to_string(some.at("rows").size()) + " of 40 "));
  check_pictures(some, folder.path);
  // The files of plots have all rows.
  const std::string svg =
      read_file(folder.path / (some.at("groups")[0].at("plots")[0].at("file").get<std::string>() + ".svg"));
  CHECK_THAT(svg, Catch::Matchers::ContainsSubstring("data-row=\"39\""));
  CHECK((rows.write(folder.path, most) == few));
}
