// SPDX-License-Identifier: Apache-2.0
#include "image/flip_metric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

namespace kage {
namespace {

using Colour = std::array<double, 3>;
using Plane = std::vector<double>;  // a value a pixel

// The screen, and the paper's constants by their names there.
constexpr double kPixelsPerDegree = 0.7 * (3840 / 0.7) * (std::numbers::pi / 180);
constexpr double kQc = 0.7;   // exponent of colour differences
constexpr double kPc = 0.4;   // differences up to this share of the largest ...
constexpr double kPt = 0.95;  // ... fill this share of the range
constexpr double kW = 0.082;  // width of the feature detectors in degrees
constexpr double kQf = 0.5;   // exponent of feature differences

/// Contrast sensitivity of a channel of opponent colours: a sum of Gaussians a sqrt(pi / b) exp(-pi^2 d^2 / b), d in
/// degrees (equation 5 and table 1).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivity{
    {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

double linear_of(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

using Matrix = std::array<Colour, 3>;

Colour operator*(const Matrix& m, const Colour& c) {
  Colour out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2];
  return out;
}

/// Linear sRGB to XYZ (IEC 61966-2-1, chromaticities of the primaries and D65 in full precision).
constexpr Matrix kToXyz{{{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                         {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                         {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};

Matrix inverse(const Matrix& m) {
  Matrix out{};
  double determinant = 0;
  for (std::size_t i = 0; i < 3; ++i)
    determinant += m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      out[k][i] = (m[(i + 1) % 3][(k + 1) % 3] * m[(i + 2) % 3][(k + 2) % 3] -
                   m[(i + 1) % 3][(k + 2) % 3] * m[(i + 2) % 3][(k + 1) % 3]) /
                  determinant;
  return out;
}

/// XYZ of white, by which XYZ is divided.
const Colour& white() {
  static const Colour kWhite = kToXyz * Colour{1, 1, 1};
  return kWhite;
}

/// Opponent colours without the cube root: the linear relative of CIELab.
Colour opponent_of(const Colour& rgb) {
  const Colour xyz = kToXyz * rgb;
  const double x = xyz[0] / white()[0];
  const double y = xyz[1] / white()[1];
  const double z = xyz[2] / white()[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Colour rgb_of(const Colour& opponent) {
  static const Matrix kToRgb = inverse(kToXyz);
  const double y = (opponent[0] + 16) / 116;
  const double x = y + opponent[1] / 500;
  const double z = y - opponent[2] / 200;
  return kToRgb * Colour{x * white()[0], y * white()[1], z * white()[2]};
}

/// CIELab, its colours weaker the darker they are (Hunt, equation 7).
Colour hunt_lab_of(const Colour& rgb) {
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const Colour xyz = kToXyz * rgb;
  const double x = f(xyz[0] / white()[0]);
  const double y = f(xyz[1] / white()[1]);
  const double z = f(xyz[2] / white()[2]);
  const double l = 116 * y - 16;
  return {l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z)};
}

/// The HyAB distance: city block in lightness, Euclidean in colour (equation 8).
double distance(const Colour& a, const Colour& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Weights of the pixels from -radius to radius.
using Kernel = std::vector<double>;

Kernel sampled(int radius, const std::function<double(double)>& f) {
  Kernel k;
  for (int i = -radius; i <= radius; ++i) k.push_back(f(i));
  return k;
}

struct Size {
  int width;
  int height;
};

/// `plane` through a kernel along x and one along y. Beyond the picture the pixel at its edge goes on.
Plane filtered(const Plane& plane, Size size, const Kernel& along_x, const Kernel& along_y) {
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
  };
  Plane half(plane.size());
  Plane out(plane.size());
  const int rx = static_cast<int>(along_x.size() / 2);
  const int ry = static_cast<int>(along_y.size() / 2);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (int i = 0; i <= 2 * rx; ++i)
        sum += along_x[static_cast<std::size_t>(i)] * plane[at(std::clamp(x + i - rx, 0, size.width - 1), y)];
      half[at(x, y)] = sum;
    }
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (int i = 0; i <= 2 * ry; ++i)
        sum += along_y[static_cast<std::size_t>(i)] * half[at(x, std::clamp(y + i - ry, 0, size.height - 1))];
      out[at(x, y)] = sum;
    }
  return out;
}

double sum_of(const Kernel& k) {
  double sum = 0;
  for (const double v : k) sum += v;
  return sum;
}

/// A channel as an eye at this distance sees it (section 4.1.1).
Plane seen(const Plane& plane, Size size, const Sensitivity& s) {
  constexpr double kMostB = 0.04;
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kMostB / (2 * std::numbers::pi * std::numbers::pi)) * kPixelsPerDegree));
  const auto gaussian = [&](double b) {
    return sampled(radius, [b](double x) {
      const double degrees = x / kPixelsPerDegree;
      return std::exp(-std::numbers::pi * std::numbers::pi * degrees * degrees / b);
    });
  };
  const Kernel k1 = gaussian(s.b1);
  const Kernel k2 = gaussian(s.b2);
  const double w1 = s.a1 * std::sqrt(std::numbers::pi / s.b1);
  const double w2 = s.a2 * std::sqrt(std::numbers::pi / s.b2);
  const double total = w1 * sum_of(k1) * sum_of(k1) + w2 * sum_of(k2) * sum_of(k2);
  Plane out = filtered(plane, size, k1, k1);
  for (double& v : out) v *= w1 / total;
  if (s.a2 == 0) return out;
  const Plane second = filtered(plane, size, k2, k2);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += second[i] * w2 / total;
  return out;
}

/// Positive weights add up to 1, negative ones to -1, each with the kernel across.
Kernel balanced(Kernel k, const Kernel& across) {
  double positive = 0;
  double negative = 0;
  for (const double v : k) (v > 0 ? positive : negative) += v;
  const double other = sum_of(across);
  for (double& v : k) v /= (v > 0 ? positive : -negative) * other;
  return k;
}

/// How much of an edge and of a point there is at each pixel (section 4.2).
struct Features {
  Plane edge;
  Plane point;
};

Features features_of(const Plane& grey, Size size) {
  const double sd = 0.5 * kW * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * sd));
  const Kernel across = sampled(radius, [sd](double x) { return std::exp(-x * x / (2 * sd * sd)); });
  const Kernel edge =
      balanced(sampled(radius, [sd](double x) { return -x * std::exp(-x * x / (2 * sd * sd)); }), across);
  const Kernel point = balanced(
      sampled(radius, [sd](double x) { return (x * x / (sd * sd) - 1) * std::exp(-x * x / (2 * sd * sd)); }), across);
  const auto length = [&](const Kernel& k) {
    Plane x = filtered(grey, size, k, across);
    const Plane y = filtered(grey, size, across, k);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], y[i]);
    return x;
  };
  return {length(edge), length(point)};
}

struct Prepared {
  std::vector<Colour> lab;
  Features features;
};

Prepared prepare(const Image& image) {
  const Size size{image.width, image.height};
  const std::size_t pixels = image.data.size() / 3;
  std::array<double, 256> linear{};
  for (std::size_t v = 0; v < linear.size(); ++v) linear[v] = linear_of(static_cast<double>(v) / 255);
  std::array<Plane, 3> planes{Plane(pixels), Plane(pixels), Plane(pixels)};
  Plane grey(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const Colour c =
        opponent_of({linear[image.data[3 * i]], linear[image.data[3 * i + 1]], linear[image.data[3 * i + 2]]});
    for (std::size_t k = 0; k < 3; ++k) planes[k][i] = c[k];
    grey[i] = (c[0] + 16) / 116;
  }
  for (std::size_t k = 0; k < 3; ++k) planes[k] = seen(planes[k], size, kSensitivity[k]);
  Prepared out{std::vector<Colour>(pixels), features_of(grey, size)};
  for (std::size_t i = 0; i < pixels; ++i) {
    Colour rgb = rgb_of({planes[0][i], planes[1][i], planes[2][i]});
    for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
    out.lab[i] = hunt_lab_of(rgb);
  }
  return out;
}

/// A colour difference on the scale 0 .. 1 (section 4.1.3).
double spread(double difference, double most) {
  const double knee = kPc * most;
  if (difference < knee) return difference * kPt / knee;
  return kPt + (difference - knee) / (most - knee) * (1 - kPt);
}

}  // namespace

FlipNumbers flip_metric(const Image& a, const Image& b) {
  const Prepared pa = prepare(a);
  const Prepared pb = prepare(b);
  // The largest difference that two colours of sRGB have: green against blue.
  const double most = std::pow(distance(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), kQc);
  FlipNumbers out;
  double sum = 0;
  for (std::size_t i = 0; i < pa.lab.size(); ++i) {
    const double colour = spread(std::pow(distance(pa.lab[i], pb.lab[i]), kQc), most);
    const double feature = std::max(std::abs(pa.features.edge[i] - pb.features.edge[i]),
                                    std::abs(pa.features.point[i] - pb.features.point[i]));
    const double error = std::pow(colour, 1 - std::pow(feature / std::numbers::sqrt2, kQf));
    sum += error;
    out.most = std::max(out.most, error);
  }
  out.mean = pa.lab.empty() ? 0 : sum / static_cast<double>(pa.lab.size());
  return out;
}

}  // namespace kage
