// SPDX-License-Identifier: Apache-2.0
// Trees in files: what was saved is loaded, and no cut or changed file is taken for one.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "kage/error.hpp"
#include "kage/order.hpp"
#include "stimulus/order_meshes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

using Catch::Matchers::ContainsSubstring;

class TempPath {
 public:
  TempPath() : path_(std::filesystem::temp_directory_path() / ("kage-order-file-" + std::to_string(::getpid()))) {}
  ~TempPath() { std::filesystem::remove(path_); }
  TempPath(const TempPath&) = delete;
  TempPath& operator=(const TempPath&) = delete;

  [[nodiscard]] const std::filesystem::path& operator*() const { return path_; }
  [[nodiscard]] std::string read() const {
    std::ostringstream out;
    out << std::ifstream(path_, std::ios::binary).rdbuf();
    return out.str();
  }
  void put(std::size_t at, char byte) const {
    std::fstream out(path_, std::ios::binary | std::ios::in | std::ios::out);
    out.seekp(static_cast<std::streamoff>(at)).put(byte);
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

 private:
  std::filesystem::path path_;
};

}  // namespace

TEST_CASE("a tree that was saved and loaded is the same") {
  Random random(test_seed());
  const TempPath file;
  const OrderTree tree = OrderTree::build(lattice_triangles(random, 40));
  tree.save(*file);
  const std::string bytes = file.read();
  const OrderTree loaded = OrderTree::load(*file);
  loaded.save(*file);
  CHECK(file.read() == bytes);
  const auto p = make_order(tree, OrderWay::fast);
  const auto q = make_order(loaded, OrderWay::fast);
  for (int i = 0; i < 100; ++i) {
    const Eye eye = random_eye(random);
    const auto right = p->update(eye);
    const auto found = q->update(eye);
    CHECK(std::equal(right.begin(), right.end(), found.begin(), found.end()));
  }
  CHECK(loaded.stats().splits == tree.stats().splits);
  // One without nodes too.
  const OrderTree none = OrderTree::build({});
  none.save(*file);
  CHECK(OrderTree::load(*file).node_count() == 0);
}

TEST_CASE("a cut or changed file is refused with its name and the place") {
  Random random(test_seed(2));
  const TempPath file;
  OrderTree::build(crossing_triangles(random, 2)).save(*file);
  const std::string bytes = file.read();
  CHECK(bytes.size() < 1500);
  const std::string name = (*file).string();
  const auto refused = [&] {
    try {
      (void)OrderTree::load(*file);
      return false;
    } catch (const Error& e) {
      return std::string(e.what()).find(name + ": byte ") == 0;
    }
  };
  // In place: a file written anew each time would take the disk's time, 10,000 times over.
  for (std::size_t n = 0; n < bytes.size(); ++n)
    for (int bit = 0; bit < 8; ++bit) {
      file.put(n, static_cast<char>(bytes[n] ^ (1 << bit)));
      if (!refused()) FAIL_CHECK("bit " << bit << " of byte " << n);
      file.put(n, bytes[n]);
    }
  for (std::size_t n = bytes.size(); n-- > 0;) {
    std::filesystem::resize_file(*file, n);
    if (!refused()) FAIL_CHECK("cut to " << n << " bytes");
  }
  file.write(bytes + "x");
  CHECK(refused());
  file.write(bytes);
  CHECK_NOTHROW(OrderTree::load(*file));
  CHECK_THROWS_WITH(OrderTree::load("/nowhere/at.all"), ContainsSubstring("/nowhere/at.all"));
  CHECK_THROWS_AS(OrderTree::load(std::filesystem::temp_directory_path()), Error);
  CHECK_THROWS_WITH(OrderTree::build({}).save("/nowhere/at.all"), ContainsSubstring("/nowhere/at.all"));
}

}  // namespace kage::verif
