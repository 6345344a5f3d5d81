// SPDX-License-Identifier: Apache-2.0
#include "json/foreign_json.hpp"

#include <fstream>
#include <functional>

#include "kage/error.hpp"
#include "test/support/catch.hpp"

namespace {

using Json = nlohmann::ordered_json;

/// `inner` within so many arrays.
std::string nested(std::size_t levels, const std::string& inner = "") {
  return std::string(levels, '[') + inner + std::string(levels, ']');
}

/// The text of the error; "taken" if there is none.
std::string said(const std::function<void()>& parse) {
  try {
    parse();
  } catch (const kage::Error& e) {
    return e.what();
  }
  return "taken";
}

std::string said_of(const std::string& text) {
  const std::string ordered = said([&] { (void)kage::parse_json<Json>(text, "f"); });
  CHECK(said([&] { (void)kage::parse_json<nlohmann::json>(text, "f"); }) == ordered);
  return ordered;
}

}  // namespace

TEST_CASE("JSON nests as deeply as the limit, whatever is round it, and copies") {
  const std::size_t most = kage::kJsonDepth;
  const Json deepest = kage::parse_json<Json>(nested(most), "f");
  Json grows;
  for (int i = 0; i < 40; ++i) grows["k" + std::to_string(i)] = deepest;  // an ordered one copies as it grows
  CHECK(grows["k0"] == deepest);
  CHECK(said_of(R"({"x":)" + nested(most - 1) + "}") == "taken");
  CHECK(said_of("[" + nested(most - 1) + "," + nested(most - 1) + "]") == "taken");
  CHECK(said_of(R"(["[[[[\"[[[\\", "]]"])") == "taken");
  CHECK(said_of("[\"" + std::string(1000, '[') + R"(\"[[", "\\"])") == "taken");
}

TEST_CASE("JSON that nests deeper is refused with its place, however deep, closed or not") {
  for (const std::size_t levels : {kage::kJsonDepth + 1, std::size_t{10'000}, std::size_t{3'000'000}})
    for (const bool closed : {true, false}) {
      const std::string text = closed ? nested(levels) : std::string(levels, '[');
      CHECK(said_of(text) == "f: line 1, column 129: arrays and objects nest more than 128 deep");
    }
  std::string objects;
  for (int i = 0; i < 200; ++i) objects += "{\"k\":\n";
  CHECK(said_of(objects) == "f: line 129, column 1: arrays and objects nest more than 128 deep");
  CHECK(said_of("[\"\\\\\"," + nested(kage::kJsonDepth) + "]") ==
        "f: line 1, column 134: arrays and objects nest more than 128 deep");
}

TEST_CASE("what is no JSON is refused with its place") {
  CHECK(said_of("") == "f: line 1, column 1: not JSON: empty");
  CHECK(said_of("[1, 2") == "f: line 1, column 6: not JSON, or cut off");
  CHECK(said_of("{\n  \"a\": tru,\n}") == "f: line 2, column 11: not JSON");
  CHECK(said_of("[1] 2") == "f: line 1, column 5: not JSON");
  CHECK(said_of("[\"\xff\"]") == "f: line 1, column 3: not JSON");
  CHECK(said_of("[1e999]") == "f: not JSON: it has a number that no double holds");
  CHECK(said([] { (void)kage::parse_json<Json>("[1, 2, 3]", "f", 8); }) ==
        "f: has more bytes than JSON may have here, 8");
}

TEST_CASE("a file of JSON is read up to the limit, and an endless one no further") {
  const auto folder = std::filesystem::temp_directory_path() / "kage_foreign_json";
  std::filesystem::create_directories(folder);
  const auto file = folder / "f.json";
  std::ofstream(file) << R"({"a": [1, 2]})";
  CHECK(kage::read_json(file)["a"].size() == 2);
  std::ofstream(file) << "[1,";
  CHECK(said([&] { (void)kage::read_json(file); }) == file.string() + ": line 1, column 4: not JSON, or cut off");
  CHECK(said([&] { (void)kage::read_json(folder / "none"); }).find("none: cannot be read") != std::string::npos);
  CHECK(said([&] { (void)kage::read_json(folder); }).find("cannot be read") != std::string::npos);
  CHECK(said([&] { (void)kage::read_json("/dev/zero"); }).find("/dev/zero: has more bytes") != std::string::npos);
  std::filesystem::remove_all(folder);
}

TEST_CASE("a member is found, and what is behind it is not parsed") {
  const std::string text = R"({"a": {"b": [1]}, "c": 3, "d": [4], no JSON)";
  CHECK(kage::json_member(text, "a", "f") == Json::parse(R"({"b": [1]})"));
  CHECK(kage::json_member(text, "c", "f") == 3);
  CHECK(kage::json_member(text, "d", "f") == Json::parse("[4]"));
  CHECK(said([&] { (void)kage::json_member(text, "e", "f"); }).find("f: line 1, column 3") == 0);
  CHECK(kage::json_member(R"({"x": {"a": 1}})", "a", "f").is_null());
}
