// SPDX-License-Identifier: Apache-2.0
//
// Trees in files. All numbers little-endian:
//
//   8 bytes   "KAGEBSP1"
//   u32       version, 1
//   u32       CRC-32 of the 8 bytes per array that follow
//   u64       number of elements, for each of the arrays below
//   arrays, one after the other: their elements, then u32 CRC-32 of them
#include <fmt/format.h>

#include <array>
#include <bit>
#include <boost/crc.hpp>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "file/temp_file.hpp"
#include "kage/error.hpp"
#include "order/data.hpp"

namespace kage {
namespace {

constexpr char kMagic[9] = "KAGEBSP1";
constexpr std::uint32_t kVersion = 1;
static_assert(std::endian::native == std::endian::little, "tree files are read and written in place");

std::uint32_t crc(const void* data, std::size_t bytes) {
  boost::crc_32_type sum;
  sum.process_bytes(data, bytes);
  return sum.checksum();
}

/// A cut as it is stored, without padding: node * 2 + front.
using StoredCut = std::uint32_t;

using StatsArray = std::array<std::uint64_t, 10>;

StatsArray to_array(const OrderBuildStats& s) {
  return {s.polygons, s.flat, s.bent, s.faces, s.nodes, s.fragments, s.splits, s.depth, s.side_tests, s.exact_tests};
}

OrderBuildStats to_stats(const StatsArray& a) { return {a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9]}; }

/// Calls `visit(name, vector)` for each array of a file, in order.
template <class Data, class Cuts, class Stats, class Visit>
void for_arrays(Data& d, Cuts& cuts, Stats& stats, Visit visit) {
  visit("statistics", stats);
  visit("vertices", d.faces.vertices);
  visit("corners", d.faces.corners);
  visit("faces", d.faces.faces);
  visit("subtree sizes", d.size);
  visit("planes", d.plane);
  visit("first fragments", d.first_fragment);
  visit("fragments", d.fragments);
  visit("cuts", cuts);
  visit("edges", d.edges);
  visit("points", d.points);
}

constexpr std::size_t kArrays = 11;
constexpr std::size_t kHeader = 16 + 8 * kArrays;

/// The fault of arrays that were read, in words; empty if they are sound.
std::string check(const order::TreeData& d) {
  using order::Face;
  const std::size_t nodes = d.size.size();
  const auto bad = [](const char* what, std::size_t i) { return fmt::format("{} {} makes no sense", what, i); };
  for (std::size_t i = 0; i < d.faces.vertices.size(); ++i)
    for (const double x : d.faces.vertices[i])
      if (!std::isfinite(x)) return bad("vertex", i);
  for (std::size_t i = 0; i < d.faces.corners.size(); ++i)
    if (d.faces.corners[i] >= d.faces.vertices.size()) return bad("corner", i);
  for (std::size_t i = 0; i < d.faces.faces.size(); ++i) {
    const Face& f = d.faces.faces[i];
    bool good = f.count >= 3 && f.first <= d.faces.corners.size() && f.count <= d.faces.corners.size() - f.first;
    for (const std::uint32_t v : f.plane) good = good && v < d.faces.vertices.size();
    if (!good) return bad("face", i);
  }
  if (d.plane.size() != nodes || d.first_fragment.size() != nodes + 1 || d.fragments.empty() ||
      d.first_fragment[0] != 0 || d.first_fragment[nodes] != d.fragments.size() - 1 ||
      d.edges.size() != d.points.size())
    return "the arrays' sizes do not fit together";
  for (std::size_t v = 0; v < nodes; ++v) {
    const std::size_t left = d.size[v] - std::size_t{1};
    bool good = d.size[v] >= 1 && d.size[v] <= nodes - v && (v != 0 || d.size[v] == nodes);
    if (good && left != 0) good = d.size[v + 1] >= 1 && d.size[v + 1] <= left;
    if (good && left != 0 && d.size[v + 1] < left) good = d.size[v + 1 + d.size[v + 1]] == left - d.size[v + 1];
    if (!good || d.plane[v] >> 1U >= d.faces.faces.size() || d.first_fragment[v] >= d.first_fragment[v + 1])
      return bad("node", v);
  }
  for (std::size_t i = 0; i + 1 < d.fragments.size(); ++i) {
    const order::FragmentRecord& f = d.fragments[i];
    const order::FragmentRecord& end = d.fragments[i + 1];
    bool good = f.face < d.faces.faces.size() && f.first_cut <= end.first_cut && end.first_cut <= d.cuts.size() &&
                f.first_edge <= end.first_edge && end.first_edge <= d.edges.size();
    for (std::size_t e = f.first_edge; good && e < end.first_edge; ++e)
      good =
          d.edges[e] < d.faces.faces[f.face].count ||
          (d.edges[e] >= OrderFragment::kCutEdge && d.edges[e] - OrderFragment::kCutEdge < end.first_cut - f.first_cut);
    if (!good) return bad("fragment", i);
  }
  for (std::size_t i = 0; i < d.cuts.size(); ++i)
    if (d.cuts[i].node >= nodes) return bad("cut", i);
  if (d.fragments.back().first_cut != d.cuts.size() || d.fragments.back().first_edge != d.edges.size())
    return "the arrays' sizes do not fit together";
  return {};
}

}  // namespace

void OrderTree::save(std::ostream& out) const {
  const Data& d = *data_;
  std::vector<StoredCut> cuts;
  for (const OrderFragment::Cut& c : d.cuts) cuts.push_back(c.node << 1U | (c.front ? 1U : 0U));
  const StatsArray stats = to_array(d.stats);
  std::array<std::uint64_t, kArrays> counts{};
  std::size_t k = 0;
  for_arrays(d, cuts, stats, [&](const char*, const auto& a) { counts[k++] = a.size(); });

  const auto put = [&](const void* data, std::size_t bytes) {
    out.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  };
  const std::array<std::uint32_t, 2> head{kVersion, crc(counts.data(), sizeof counts)};
  put(kMagic, 8);
  put(head.data(), sizeof head);
  put(counts.data(), sizeof counts);
  for_arrays(d, cuts, stats, [&](const char*, const auto& a) {
    const std::size_t bytes = a.size() * sizeof a[0];
    const std::uint32_t sum = crc(a.data(), bytes);
    put(a.data(), bytes);
    put(&sum, sizeof sum);
  });
}

void OrderTree::save(const std::filesystem::path& path) const {
  TempFiles files;
  OutputFile out(files, path);
  save(out);
  out.close();
  files.commit();
}

OrderTree OrderTree::load(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& why) { throw Error(fmt::format("{}: {}", path.string(), why)); };
  std::error_code ec;
  if (!std::filesystem::is_regular_file(path, ec)) fail("no such file");
  std::ifstream in(path, std::ios::binary);
  const std::uint64_t size = std::filesystem::file_size(path, ec);
  if (!in || ec) fail(std::string("cannot be read: ") + std::strerror(errno));

  std::array<char, 16> head{};
  std::array<std::uint64_t, kArrays> counts{};
  in.read(head.data(), head.size());
  in.read(reinterpret_cast<char*>(counts.data()), sizeof counts);
  if (std::memcmp(head.data(), kMagic, 8) != 0) fail("byte 0: not a tree that kage saved");
  std::array<std::uint32_t, 2> numbers{};
  std::memcpy(numbers.data(), head.data() + 8, sizeof numbers);
  if (numbers[0] != kVersion) fail(fmt::format("byte 8: version {}, this kage reads {}", numbers[0], kVersion));
  if (!in || numbers[1] != crc(counts.data(), sizeof counts)) fail("byte 16: cut off, or its checksum is wrong");

  auto data = std::make_unique<Data>();
  std::vector<StoredCut> cuts;
  StatsArray stats{};
  std::uint64_t at = kHeader;
  std::size_t k = 0;
  for_arrays(*data, cuts, stats, [&](const char* name, auto& a) {
    const std::uint64_t count = counts[k++];
    constexpr std::size_t kElement = sizeof a[0];
    if (count > (size - at) / kElement || count >= kNoNode || size - at - count * kElement < 4)
      fail(fmt::format("byte {}: {} cut off", at, name));
    if constexpr (std::is_same_v<std::remove_reference_t<decltype(a)>, StatsArray>) {
      if (count != a.size()) fail(fmt::format("byte {}: {} {}", at, count, name));
    } else {
      a.resize(count);
    }
    std::uint32_t sum = 0;
    in.read(reinterpret_cast<char*>(a.data()), static_cast<std::streamsize>(count * kElement));
    in.read(reinterpret_cast<char*>(&sum), sizeof sum);
    if (!in || sum != crc(a.data(), count * kElement)) fail(fmt::format("byte {}: checksum of {} is wrong", at, name));
    at += count * kElement + 4;
  });
  if (at != size) fail(fmt::format("byte {}: {} bytes too many", at, size - at));
  for (const StoredCut c : cuts) data->cuts.push_back({c >> 1U, (c & 1U) != 0});
  data->stats = to_stats(stats);
  if (const std::string why = check(*data); !why.empty()) fail(why);
  data->faces.derive();
  data->derive();
  return OrderTree(std::move(data));
}

bool is_order_file(const std::filesystem::path& path) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(path, ec)) return false;
  constexpr std::string_view kName = std::string_view(kMagic).substr(0, 7);  // the rest is the version
  std::array<char, kName.size()> begins{};
  std::ifstream(path, std::ios::binary).read(begins.data(), begins.size());
  return std::string_view(begins.data(), begins.size()) == kName;
}

}  // namespace kage
