// SPDX-License-Identifier: Apache-2.0
//
// Random meshes, written in each plain format in a random way, come back as they were. Files that are then changed at
// random are read or refused in one line; no reader does anything else with them.
#include <fmt/format.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <random>

#include "kage/error.hpp"
#include "plain_outcome.hpp"
#include "scene/import.hpp"
#include "test/support/catch.hpp"

using namespace kage;

namespace {

struct Mesh {
  std::vector<std::array<int, 3>> places;  // quarters
  std::vector<std::vector<std::uint32_t>> faces;
  std::vector<std::array<int, 3>> colors;  // of faces, 0 .. 255
};

using Random = std::mt19937;
int below(Random& random, int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }

Mesh random_mesh(Random& random) {
  Mesh m;
  const int vertices = 3 + below(random, 20);
  for (int i = 0; i < vertices; ++i)  // all places differ, by x
    m.places.push_back({4 * i + below(random, 4), below(random, 400) - 200, below(random, 400) - 200});
  const int faces = 1 + below(random, 20);
  for (int i = 0; i < faces; ++i) {
    std::vector<std::uint32_t> all(m.places.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<std::uint32_t>(k);
    std::shuffle(all.begin(), all.end(), random);
    all.resize(3);
    m.faces.push_back(all);
    m.colors.push_back({below(random, 256), below(random, 256), 2 + below(random, 254)});
  }
  return m;
}

std::string number(Random& random, int quarters) {
  const double v = quarters / 4.0;
  const std::array<std::string, 4> forms{fmt::format("{}", v), fmt::format("{:.4f}", v), fmt::format("{:e}", v),
                                         fmt::format("{:+.2E}", v)};
  const std::size_t form = static_cast<std::size_t>(below(random, std::abs(v) < 100 && quarters % 4 == 0 ? 4 : 3));
  return forms[form == 3 && std::abs(v) >= 10 ? 0 : form];
}

std::string blank(Random& random) {
  return std::array<const char*, 4>{" ", "  ", "\t", " \t "}[static_cast<std::size_t>(below(random, 4))];
}

std::string place(Random& random, const std::array<int, 3>& p) {
  return number(random, p[0]) + blank(random) + number(random, p[1]) + blank(random) + number(random, p[2]);
}

std::string obj(const Mesh& m, Random& random) {
  const std::string end = below(random, 2) == 0 ? "\n" : "\r\n";
  const bool ahead = below(random, 2) == 0;
  std::string places, faces;
  for (const auto& p : m.places) {
    if (below(random, 4) == 0) places += "# a comment \\" + end;
    places += "v" + blank(random) + place(random, p) + (below(random, 4) == 0 ? blank(random) : "") + end;
  }
  const auto n = static_cast<int>(m.places.size());
  for (const auto& f : m.faces) {
    faces += 'f';
    for (const std::uint32_t v : f) {
      if (below(random, 8) == 0) faces += " \\" + end;
      faces += blank(random) +
               std::to_string(!ahead && below(random, 2) == 0 ? static_cast<int>(v) - n : static_cast<int>(v) + 1);
      faces += std::array<const char*, 4>{"", "/7", "/", "//"}[static_cast<std::size_t>(below(random, 4))];
    }
    faces += end;
  }
  return ahead ? faces + places : places + faces;
}

std::string off(const Mesh& m, Random& random) {
  std::string text =
      fmt::format("OFF{}{} {} 0\n", below(random, 2) == 0 ? " " : "\n# c\n", m.places.size(), m.faces.size());
  for (const auto& p : m.places) text += place(random, p) + "\n";
  for (std::size_t i = 0; i < m.faces.size(); ++i) {
    text += '3';
    for (const std::uint32_t v : m.faces[i]) text += blank(random) + std::to_string(v);
    for (const int c : m.colors[i]) text += blank(random) + std::to_string(c);
    text += '\n';
  }
  return text;
}

template <typename T>
std::string as_bytes(T value, bool big) {
  std::string s = test::bytes_of(std::vector<T>{value});
  if (big) std::reverse(s.begin(), s.end());
  return s;
}

std::string ply(const Mesh& m, Random& random) {
  const int form = below(random, 3);
  const bool text = form == 0;
  const bool big = form == 2;
  std::string s = fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty double w\nproperty float y\nproperty float "
      "z\n",
      std::array<const char*, 3>{"ascii", "binary_little_endian", "binary_big_endian"}[static_cast<std::size_t>(form)],
      m.places.size());
  s += fmt::format(
      "element face {}\nproperty uchar red\nproperty list uchar ushort vertex_indices\nproperty uchar green\nproperty "
      "uchar blue\nend_header\n",
      m.faces.size());
  const auto real = [&](int quarters) {
    return text ? number(random, quarters) + " " : as_bytes(static_cast<float>(quarters) / 4, big);
  };
  const auto byte = [&](int v) { return text ? std::to_string(v) + " " : as_bytes(static_cast<std::uint8_t>(v), big); };
  for (const auto& p : m.places)
    s += real(p[0]) + (text ? "9.5 " : as_bytes(9.5, big)) + real(p[1]) + real(p[2]) + (text ? "\n" : "");
  for (std::size_t i = 0; i < m.faces.size(); ++i) {
    s += byte(m.colors[i][0]) + byte(3);
    for (const std::uint32_t v : m.faces[i])
      s += text ? std::to_string(v) + " " : as_bytes(static_cast<std::uint16_t>(v), big);
    s += byte(m.colors[i][1]) + byte(m.colors[i][2]) + (text ? "\n" : "");
  }
  return s;
}

std::string stl(const Mesh& m, Random& random) {
  const bool text = below(random, 2) == 0;
  std::string s = text ? "solid random mesh\n"
                       : std::string("solid") + std::string(75, ' ') +
                             test::bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(m.faces.size())});
  for (const auto& f : m.faces) {
    if (text) s += "facet normal 0 0 0\nouter loop\n";
    if (!text) s += std::string(12, '\0');
    for (const std::uint32_t v : f)
      if (text)
        s += "vertex" + blank(random) + place(random, m.places[v]) + "\n";
      else
        for (const int c : m.places[v]) s += as_bytes(static_cast<float>(c) / 4, false);
    s += text ? "endloop\nendfacet\n" : std::string(2, '\0');
  }
  return text ? s + "endsolid\n" : s;
}

using Read = scene::RawScene (*)(const std::filesystem::path&, const std::string&);
scene::RawScene read_obj(const std::filesystem::path& path, const std::string& name) {
  return scene::import_obj(path, name);
}

struct Format {
  const char* name;
  std::string (*write)(const Mesh&, Random&);
  Read read;
  bool colored;
};
const std::array<Format, 4> kFormats{{{"obj", obj, read_obj, false},
                                      {"off", off, scene::import_off, true},
                                      {"ply", ply, scene::import_ply, true},
                                      {"stl", stl, scene::import_stl, false}}};

/// Places and colours of all corners, in the file's order.
std::vector<std::array<float, 6>> corners(const scene::RawScene& s) {
  std::vector<std::array<float, 6>> all;
  for (const scene::RawMesh& mesh : s.meshes)
    for (const scene::RawPrimitive& p : mesh.primitives)
      for (const std::size_t c : p.corners) {
        std::array<float, 6> corner{};
        for (std::size_t i = 0; i < 3; ++i) {
          corner[i] = p.positions[3 * c + i];
          corner[3 + i] = p.colors.empty() ? 0 : p.colors[3 * c + i];
        }
        all.push_back(corner);
      }
  return all;
}

std::vector<std::array<float, 6>> corners(const Mesh& m, bool colored) {
  std::vector<std::array<float, 6>> all;
  for (std::size_t i = 0; i < m.faces.size(); ++i)
    for (const std::uint32_t v : m.faces[i]) {
      std::array<float, 6> corner{};
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = static_cast<float>(m.places[v][k]) / 4;
        corner[3 + k] = colored ? static_cast<float>(m.colors[i][k]) / 255 : 0;
      }
      all.push_back(corner);
    }
  return all;
}

void change(std::string& text, Random& random) {
  constexpr std::array<const char*, 20> kBits{
      "\n",    "\r",          " ",          "#",         "\\",   "/",  "-", "nan",
      "1e39",  "99999999999", "v ",         "f ",        "\xff", "\t", ".", "element face 7\n",
      "list ", "usemtl x\n",  "endsolid\n", "4294967295"};
  for (int i = 1 + below(random, 3); i-- > 0 && !text.empty();) {
    const auto at = static_cast<std::size_t>(below(random, static_cast<int>(text.size())));
    switch (below(random, 5)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, 1 + static_cast<std::size_t>(below(random, 8)));
        break;
      case 2:
        text.insert(at, kBits[static_cast<std::size_t>(below(random, static_cast<int>(kBits.size())))]);
        break;
      case 3:
        text.resize(at);
        break;
      default:
        text.insert(at, text.substr(at / 2, static_cast<std::size_t>(below(random, 40))));
    }
  }
}

}  // namespace

TEST_CASE("a mesh comes back from each format as it was written") {
  const test::TempDirectory dir;
  rc::check("reading gives what was written", [&dir] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    const Mesh mesh = random_mesh(random);
    for (const Format& format : kFormats) {
      const std::string text = format.write(mesh, random);
      RC_LOG() << format.name << "\n" << text;
      const scene::RawScene read = format.read(dir.write("m", text), "m");
      RC_ASSERT(corners(read) == corners(mesh, format.colored));
    }
  });
}

TEST_CASE("a file that is changed at random is read or refused in one line") {
  const test::TempDirectory dir;
  std::size_t refused = 0;
  std::size_t read = 0;
  Random random(47);
  for (int i = 0; i < 3000; ++i) {
    const Format& format = kFormats[static_cast<std::size_t>(i) % kFormats.size()];
    std::string text = format.write(random_mesh(random), random);
    change(text, random);
    try {
      scene::RawScene scene = format.read(dir.write("m", text), "m");
      scene::check(scene, "m");
      ++read;
    } catch (const Error& e) {
      ++refused;
      const std::string message = e.what();
      INFO(format.name << ": " << message << "\n" << text);
      REQUIRE(message.rfind("m: ", 0) == 0);
      REQUIRE(message.find('\n') == std::string::npos);
      REQUIRE(message.size() < 300);
    }
  }
  CHECK(read > 300);
  CHECK(refused > 300);
}
