// SPDX-License-Identifier: Apache-2.0
#include "json/foreign_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "file/plain_io.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

using Ordered = nlohmann::ordered_json;

[[noreturn]] void fail_at(std::string_view text, std::size_t at, const std::string& name, const std::string& cause) {
  const std::string_view before = text.substr(0, at);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
  throw Error(fmt::format("{}: line {}, column {}: {}", name, line, at - start + 1, cause));
}

void check_bytes(std::size_t has, std::size_t most, const std::string& name) {
  if (has > most) throw Error(fmt::format("{}: has more bytes than JSON may have here, {}", name, most));
}

/// Throws Error where arrays and objects nest too deeply. Brackets are counted before anything is parsed: up to the
/// first place that is no JSON these are the parser's levels, and behind it the parser does not go.
void check_depth(std::string_view text, const std::string& name) {
  std::size_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kJsonDepth)
        fail_at(text, i, name, fmt::format("arrays and objects nest more than {} deep", kJsonDepth));
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
}

/// The words of the parser's exception on a text.
[[noreturn]] void fail_parse(std::string_view text, const std::string& name, const Ordered::exception& e) {
  if (const auto* const where = dynamic_cast<const Ordered::parse_error*>(&e)) {
    const std::size_t at = where->byte == 0 ? 0 : where->byte - 1;
    if (at >= text.size()) fail_at(text, text.size(), name, text.empty() ? "not JSON: empty" : "not JSON, or cut off");
    fail_at(text, at, name, "not JSON");
  }
  if (dynamic_cast<const Ordered::out_of_range*>(&e) != nullptr)
    throw Error(fmt::format("{}: not JSON: it has a number that no double holds", name));
  throw Error(fmt::format("{}: not JSON", name));
}

/// Runs `parse`, whose text is checked first.
template <class Parse>
auto guarded(std::string_view text, const std::string& name, std::size_t bytes, Parse parse) {
  check_bytes(text.size(), bytes, name);
  check_depth(text, name);
  try {
    return parse();
  } catch (const Ordered::exception& e) {
    fail_parse(text, name, e);
  }
}

}  // namespace

template <class Json>
Json parse_json(std::string_view text, const std::string& name, std::size_t bytes) {
  return guarded(text, name, bytes, [&] { return Json::parse(text.begin(), text.end()); });
}
template nlohmann::json parse_json(std::string_view, const std::string&, std::size_t);
template Ordered parse_json(std::string_view, const std::string&, std::size_t);

Ordered read_json(const std::filesystem::path& file) {
  const std::string name = file.string();
  const ReadOnly in(file);
  std::string text;
  std::vector<char> piece(std::size_t{1} << 16);
  while (const std::size_t n = in.read(piece.data(), piece.size())) {
    text.append(piece.data(), n);
    check_bytes(text.size(), kJsonBytes, name);
  }
  return parse_json<Ordered>(text, name);
}

Ordered json_member(std::string_view text, const std::string& key, const std::string& name) {
  struct Enough {};
  Ordered member;
  std::string at;
  const auto look = [&](int depth, Ordered::parse_event_t event, Ordered& value) {
    using Event = Ordered::parse_event_t;
    if (depth == 1 && event == Event::key) at = value.get<std::string>();
    const bool ended = event == Event::object_end || event == Event::array_end || event == Event::value;
    if (depth != 1 || !ended || at != key) return true;
    member = value;
    throw Enough();
  };
  try {
    (void)guarded(text, name, kJsonBytes, [&] { return Ordered::parse(text.begin(), text.end(), look); });
  } catch (const Enough&) {
  }
  return member;
}

}  // namespace kage
