// SPDX-License-Identifier: Apache-2.0
#include "geometry/translucent.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>

#include "order/exact.hpp"
#include "order/filter.hpp"
#include "scene/order_mesh.hpp"

namespace kage {

struct TranslucentOrder::Data {
  OrderMesh mesh;
  std::optional<OrderTree> tree;
  std::unique_ptr<VisibilityOrder> order;
};

TranslucentOrder::TranslucentOrder() : data_(std::make_unique<Data>()) {}
TranslucentOrder::~TranslucentOrder() = default;
TranslucentOrder::TranslucentOrder(TranslucentOrder&&) noexcept = default;
TranslucentOrder& TranslucentOrder::operator=(TranslucentOrder&&) noexcept = default;

namespace {

OrderPoint point(const glm::dvec3& p) { return {p.x, p.y, p.z}; }

Eye eye_of(const Camera& camera) {
  return camera.perspective ? Eye::point(point(camera.eye)) : Eye::parallel(point(camera.forward));
}

bool same(const OrderMesh& a, const OrderMesh& b) {
  const auto equal = [](const OrderMesh::Polygon& p, const OrderMesh::Polygon& q) {
    return p.first == q.first && p.count == q.count;
  };
  return a.vertices == b.vertices && a.corners == b.corners &&
         std::equal(a.polygons.begin(), a.polygons.end(), b.polygons.begin(), b.polygons.end(), equal);
}

}  // namespace

int eye_side(const Camera& camera, const std::array<glm::dvec3, 3>& face) {
  std::array<OrderPoint, 4> p{point(face[0]), point(face[1]), point(face[2]), point(camera.eye)};
  const std::array<OrderPoint, 4> given = p;
  // The filter's bound is for coordinates up to 1.
  const order::Scale scale = order::scale_of(std::span(p).first(camera.perspective ? 4 : 3));
  for (OrderPoint& q : p) q = scale(q);
  const order::FilterPlane plane(p[0], p[1], p[2]);
  const OrderPoint forward = point(camera.forward);
  const double value = camera.perspective ? plane.value(p[3]) : -plane.slope(forward);
  const double error = camera.perspective ? plane.error(p[3]) : plane.slope_error(forward);
  if (std::abs(value) > error) return value > 0 ? 1 : -1;
  const order::PlanePoints exact{given[0], given[1], given[2]};
  return camera.perspective ? order::exact_side(exact, given[3]) : -order::exact_facing(exact, forward);
}

// A point before the camera is eye + t (ex right + ey up + forward) (perspective) or eye + ex right + ey up + t forward
// (parallel), ex and ey linear on the screen. On which side of the node's plane, n . (p - p0), the face's point at (ex,
// ey) lies follows by putting in the t at which the face's plane m . (q - q0) = 0 is met. With dn = n . (eye - p0) and
// dm likewise, and (nx, ny, nz), (mx, my, mz) the normals along the camera's axes, e = (ex, ey, 1):
//   perspective: (dm (n . e) - dn (m . e)) / dm > 0 is the front, since m . e has the opposite sign of dm where t > 0;
//   parallel: ((mz nx - nz mx) ex + (mz ny - nz my) ey + mz dn - nz dm) / mz > 0 is.
// The sign of dm, or mz, is that of the eye's exact side.
CutLine cut_line(const View& view, const Camera& camera, const std::array<glm::dvec3, 3>& face, int side,
                 const std::array<glm::dvec3, 3>& node) {
  const auto along_axes = [&](const std::array<glm::dvec3, 3>& p) {
    const glm::dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
    return glm::dvec3{glm::dot(n, camera.right), glm::dot(n, camera.up), glm::dot(n, camera.forward)};
  };
  const auto distance = [&](const std::array<glm::dvec3, 3>& p) {
    return glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), camera.eye - p[0]);
  };
  const glm::dvec3 n = along_axes(node);
  const glm::dvec3 m = along_axes(face);
  const double dn = distance(node);
  const double dm = distance(face);
  if (camera.perspective) return view.line(static_cast<double>(side) * (dm * n - dn * m));
  // The eye is before a face that looks against the view: mz < 0.
  return view.line(static_cast<double>(-side) *
                   glm::dvec3{m.z * n.x - n.z * m.x, m.z * n.y - n.z * m.y, m.z * dn - n.z * dm});
}

FragmentMaker::FragmentMaker(const SceneFrame& frame, const View& view, TranslucentOrder::Data& kept,
                             std::span<const std::uint32_t> faces, std::span<const int> sides)
    : frame_(&frame), view_(&view), kept_(&kept), faces_(faces), sides_(sides) {}

std::vector<std::uint32_t> FragmentMaker::whole(TranslucentWay way) const {
  std::vector<std::uint32_t> order(faces_.size());
  std::iota(order.begin(), order.end(), 0U);
  if (way == TranslucentWay::submission) return order;
  std::vector<double> depth;
  for (const std::uint32_t f : faces_) {
    const auto p = triangle_of(*frame_, f);
    depth.push_back(glm::dot((p[0] + p[1] + p[2]) / 3.0 - frame_->camera.eye, frame_->camera.forward));
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return depth[a] > depth[b]; });
  return order;
}

std::span<const std::uint32_t> FragmentMaker::nodes() {
  OrderMesh mesh = scene::order_mesh(*frame_, faces_);
  if (!kept_->tree || !same(mesh, kept_->mesh)) {
    kept_->order.reset();
    kept_->tree = OrderTree::build(mesh);
    kept_->mesh = std::move(mesh);
    kept_->order = make_order(*kept_->tree, OrderWay::kFast);
  }
  return kept_->order->update(eye_of(frame_->camera));
}

const OrderTree& FragmentMaker::tree() const { return *kept_->tree; }

std::uint32_t FragmentMaker::line_of(std::uint32_t face, std::uint32_t node, FrameGeometry& out) {
  const auto [it, fresh] =
      lines_.emplace(std::uint64_t{node} << 32 | face, static_cast<std::uint32_t>(out.cut_lines.size()));
  if (!fresh) return it->second;
  std::array<glm::dvec3, 3> plane{};
  const auto numbers = tree().plane(node);
  for (std::size_t i = 0; i < 3; ++i) {
    const OrderPoint& p = tree().vertices()[numbers[i]];
    plane[i] = {p[0], p[1], p[2]};
  }
  out.cut_lines.push_back(cut_line(*view_, frame_->camera, triangle_of(*frame_, faces_[face]), sides_[face], plane));
  return it->second;
}

void FragmentMaker::add(std::uint32_t face, std::uint32_t first, std::uint32_t count, const OrderFragment* fragment,
                        FrameGeometry& out) {
  ScreenFragment f;
  f.first_polygon = first;
  f.polygon_count = count;
  f.first_cut = static_cast<std::uint32_t>(out.cuts.size());
  if (fragment != nullptr)
    for (const OrderFragment::Cut& cut : fragment->cuts) out.cuts.push_back({line_of(face, cut.node, out), cut.front});
  f.cut_count = static_cast<std::uint32_t>(out.cuts.size()) - f.first_cut;
  f.first_line = out.height;
  f.end_line = 0;
  for (std::uint32_t i = first; i < first + count; ++i) {
    search_.start(out.outline(out.polygons[i]));
    for (const FragmentCut& cut : std::span(out.cuts).subspan(f.first_cut, f.cut_count))
      search_.cut(out.cut_lines[cut.line], cut.front);
    search_.join(f.first_line, f.end_line);
  }
  f.first_line = std::max(f.first_line, 0);
  f.end_line = std::min(f.end_line, out.height);
  if (f.first_line >= f.end_line) {
    out.cuts.resize(f.first_cut);
    return;
  }
  out.fragments.push_back(f);
}

}  // namespace kage
