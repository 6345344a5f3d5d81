// SPDX-License-Identifier: Apache-2.0
#include "geometry/translucent.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>

#include "geometry/order_mesh.hpp"
#include "order/exact.hpp"
#include "order/filter.hpp"

namespace kage {

struct TranslucentOrder::Data {
  OrderBuildOptions build;
  OrderMesh mesh;
  std::optional<OrderTree> tree;
  std::unique_ptr<VisibilityOrder> order;
};

TranslucentOrder::TranslucentOrder(OrderBuildOptions build) : data_(std::make_unique<Data>()) {
  data_->build = std::move(build);
}
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

namespace {

/// A function on the picture (cut_line()), and how far rounding has put each of its numbers off at most.
struct Meeting {
  glm::dvec3 l;
  glm::dvec3 error;
};

/// order::exact_meeting() in doubles, up to a positive factor.
Meeting meeting(const order::Picture& picture, const order::PlanePoints& face, const order::PlanePoints& node) {
  std::array<OrderPoint, 7> p{node.a, node.b, node.c, face.a, face.b, face.c, picture.eye};
  const order::Scale scale = order::scale_of(p);  // the filter's bounds are for coordinates up to 1
  for (OrderPoint& q : p) q = scale(q);
  const order::FilterPlane planes[2] = {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}};
  const std::array<OrderPoint, 3> axes{picture.right, picture.up, picture.forward};
  // For node and face: the normal along the axes, the eye's value, and the errors of both.
  std::array<glm::dvec3, 2> along, along_error;
  std::array<double, 2> at, at_error;
  for (std::size_t i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) {
      along[i][k] = planes[i].slope(axes[static_cast<std::size_t>(k)]);
      along_error[i][k] = planes[i].slope_error(axes[static_cast<std::size_t>(k)]);
    }
    at[i] = planes[i].value(p[6]);
    at_error[i] = planes[i].error(p[6]);
  }
  Meeting m;
  // a b - c d, each off by so much; the products and the difference round once more.
  const auto set = [&m](int k, double a, double a_error, double b, double b_error, double c, double c_error, double d,
                        double d_error) {
    m.l[k] = a * b - c * d;
    m.error[k] = (std::abs(a) * b_error + (std::abs(b) + b_error) * a_error + std::abs(c) * d_error +
                  (std::abs(d) + d_error) * c_error + (std::abs(a * b) + std::abs(c * d)) * 0x1p-51) *
                     (1 + 0x1p-40) +
                 order::kTiny;
  };
  for (int k = 0; k < 3; ++k)
    if (picture.perspective)
      set(k, at[1], at_error[1], along[0][k], along_error[0][k], at[0], at_error[0], along[1][k], along_error[1][k]);
    else if (k < 2)
      set(k, along[1].z, along_error[1].z, along[0][k], along_error[0][k], along[0].z, along_error[0].z, along[1][k],
          along_error[1][k]);
    else
      set(k, along[1].z, along_error[1].z, at[0], at_error[0], along[0].z, along_error[0].z, at[1], at_error[1]);
  if (!picture.perspective) {  // the last has a length in space more
    m.l.z = std::ldexp(m.l.z, scale.exponent);
    m.error.z = std::ldexp(m.error.z, scale.exponent);
  }
  return m;
}

order::PlanePoints plane_points(const std::array<glm::dvec3, 3>& p) { return {point(p[0]), point(p[1]), point(p[2])}; }

}  // namespace

// A point before the camera is eye + t (ex right + ey up + forward) (perspective) or eye + ex right + ey up + t forward
// (parallel), ex and ey linear on the screen. A face's point at (ex, ey) has the t at which the face's plane
// m . (q - q0) = 0 is met. That t, put into n . (p - p0), gives the side of the node's plane on which the point lies.
// Let dn = n . (eye - p0) and dm likewise, (nx, ny, nz) and (mx, my, mz) the normals along the camera's axes, and
// e = (ex, ey, 1). Then the front is where this is > 0 (in perspective, since m . e has dm's opposite sign where t >
// 0):
//   perspective:  (dm (n . e) - dn (m . e)) / dm
//   parallel:     ((mz nx - nz mx) ex + (mz ny - nz my) ey + mz dn - nz dm) / mz.
// The sign of dm, or mz, is that of the eye's exact side; the eye is before a face that looks against the view: mz < 0.
//
// The tree was cut where planes meet exactly, and its order holds for those cuts alone. So where doubles cannot tell
// the line to a fraction of a pixel (planes that nearly coincide, a face so thin that its normal in doubles is nothing
// but rounding) integers do.
CutLine cut_line(const View& view, const Camera& camera, const std::array<glm::dvec3, 3>& face, int side,
                 const std::array<glm::dvec3, 3>& node) {
  const order::Picture picture{camera.perspective, point(camera.eye), point(camera.right), point(camera.up),
                               point(camera.forward)};
  const order::PlanePoints m = plane_points(face);
  const order::PlanePoints n = plane_points(node);
  Meeting found = meeting(picture, m, n);
  if (!view.is_fine(found.l, found.error)) {
    const OrderPoint l = order::exact_meeting(m, n, picture);
    found.l = {l[0], l[1], l[2]};
  }
  return view.line((camera.perspective ? static_cast<double>(side) : static_cast<double>(-side)) * found.l);
}

FragmentMaker::FragmentMaker(const SceneFrame& frame, const View& view, TranslucentOrderInside::Data& kept,
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
  OrderMesh mesh = order_mesh(*frame_, faces_);
  if (!kept_->tree || !same(mesh, kept_->mesh)) {
    kept_->order.reset();
    kept_->tree.reset();
    kept_->tree = OrderTree::build(mesh, kept_->build);
    kept_->mesh = std::move(mesh);
    kept_->order = make_order(*kept_->tree, OrderWay::fast);
  }
  return kept_->order->update(eye_of(frame_->camera));
}

const OrderTree& FragmentMaker::tree() const { return *kept_->tree; }

void FragmentMaker::report() const {
  if (kept_->build.progress) kept_->build.progress(1);
}

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
