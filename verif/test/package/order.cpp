// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <kage/order.hpp>

int main() {
  try {
    kage::OrderMesh mesh;  // two panes through one another
    mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    mesh.corners = {0, 1, 2, 3, 4, 5, 6, 7};
    mesh.polygons = {{0, 4}, {4, 4}};
    const kage::OrderTree tree = kage::OrderTree::build(mesh);
    const auto order = kage::make_order(tree, kage::OrderWay::fast);
    std::printf("back to front:");
    for (const std::uint32_t node : order->update(kage::Eye::point({0.5, 3, 4})))
      for (std::uint32_t f = tree.first_fragment(node); f < tree.first_fragment(node + 1); ++f)
        std::printf(" a piece of polygon %u", tree.face(tree.fragment(f).face).polygon);
    std::printf("\n");
    return tree.stats().splits == 1 ? 0 : 1;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
