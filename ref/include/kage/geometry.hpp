// SPDX-License-Identifier: Apache-2.0

/// @file
/// Geometry: a scene's frame as integers on the screen. Scenes are floating point; from here on
/// all numbers are integers.
///
/// Screen coordinates are 16.8 fixed point: x to the right, y down, (0, 0) the upper left corner of the upper left
/// pixel, whose centre is (128, 128). All lie within +-(2^15 - 1) pixels. Depth is linear on the screen, smaller is
/// nearer: 1 where it begins, 2^Z_BITS - 2 at the frame's furthest vertex. It begins at w0, the least distance at which
/// the picture shows a face, rounded down. So w0 rarely changes from frame to frame, and costs at most a bit.
/// docs/numbers.md has the rule, and every rounding with its bound.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kage/config.hpp"
#include "kage/defs.hpp"
#include "kage/order.hpp"
#include "kage/scene.hpp"
#include "kage/shadow.hpp"

namespace kage {

/// Widest and highest picture: guard-band clipping cuts at 2^15 - 1, at least a pixel off screen.
inline constexpr int kMaxSize = 32766;
/// Limit of a snapped coordinate, in pixels.
inline constexpr int kGuard = 32767;
/// Least and most bits of a snapped coordinate's fraction: Look::sub_bits.
inline constexpr int kLeastSubBits = 4;
inline constexpr int kMostSubBits = 8;  ///< all that a coordinate has

/// A vertex after the snap, 16.8.
struct ScreenVertex {
  std::int32_t x = 0;  ///< to the right, in 1/256 pixel
  std::int32_t y = 0;  ///< down, in 1/256 pixel

  bool operator==(const ScreenVertex&) const = default;
};

/// A plane over the screen: its value at the centre of pixel (x, y) is (c + a (x - x0) + b (y - y0)) / 2^24. The
/// anchor (x0, y0) keeps c within 64 bits, which the value at pixel (0, 0), c - a x0 - b y0, may leave. |a|, |b| <=
/// 2^60.
struct ScreenPlane {
  std::int64_t a = 0;   ///< slope in x, per pixel, in 2^-24
  std::int64_t b = 0;   ///< slope in y, likewise
  std::int64_t c = 0;   ///< value at the anchor, in 2^-24
  std::int32_t x0 = 0;  ///< pixel of the anchor
  std::int32_t y0 = 0;  ///< line of the anchor
};

/// A snapped polygon. Its outline is filled by winding number, so snapping may bend it without losing or doubling a
/// pixel.
struct ScreenPolygon {
  std::uint32_t first_vertex = 0;       ///< into FrameGeometry::vertices
  std::uint32_t vertex_count = 0;       ///< at least 3
  ScreenPlane depth;                    ///< in depth steps
  std::array<std::uint8_t, 3> color{};  ///< flat colour, as displayed
  std::int32_t color_planes = -1;       ///< first of three in FrameGeometry::color_planes, or -1: flat
  /// With linear light, of an opaque one: first in FrameGeometry::color_planes of three for the light from everywhere
  /// and three for each pass, or -1.
  std::int32_t light_planes = -1;
  std::int32_t shade_cut = -1;  ///< the first that parts it, in FrameGeometry::shade_cuts; -1: it is not diced
  /// Eye and some light that casts shadows are on the same side of it, and it is not Triangle::unlit.
  bool lit = false;
  std::uint32_t normal_class = 0;  ///< into the light table, from 1; 0 if it is not lit or there is no table
  std::uint32_t source = 0;        ///< where it comes from, into SceneFrame::polygons; ~0 for a volume's side
  std::uint8_t alpha = 255;        ///< below 255: translucent
};

/// A line over the screen, along which a node's plane of the visibility order cuts a translucent polygon.
/// A pixel (x, y) lies before the plane if a x + b y + c >= 0. |a|, |b| <= 2^30, |c| <= 2^58.
struct CutLine {
  std::int64_t a = 0;  ///< by x
  std::int64_t b = 0;  ///< by y
  std::int64_t c = 0;  ///< at pixel (0, 0)
};

/// A cut of a drawn polygon whose colour is not linear enough (Look::max_shading). Cuts are a tree, the ends of which
/// are shades. They part colours and classes alone: outline, depth and shadows stay those of the whole polygon.
struct ShadeCut {
  CutLine line;             ///< that parts the pixels
  std::int32_t front = 0;   ///< of those before the line: a further cut, or ~ of a number in FrameGeometry::shades
  std::int32_t behind = 0;  ///< of the others, likewise
};

/// Colour and class of a part of a diced polygon.
struct Shade {
  /// First of three in FrameGeometry::color_planes; with linear light of as many as ScreenPolygon::light_planes has.
  std::uint32_t color_planes = 0;
  std::uint32_t normal_class = 0;  ///< as ScreenPolygon::normal_class
};

/// A fragment of a translucent face: of the face's polygons what lies on the given sides of lines. The fragments of a
/// face share the lines that part them, so that each of its pixels belongs to exactly one.
struct ScreenFragment {
  std::uint32_t first_polygon = 0;  ///< into FrameGeometry::polygons; of one face
  std::uint32_t polygon_count = 0;  ///< at least 1
  std::uint32_t first_cut = 0;      ///< into FrameGeometry::cuts
  std::uint32_t cut_count = 0;      ///< lines that part it from others
  std::int32_t first_line = 0;      ///< it has pixels on no other lines than [first_line, end_line)
  std::int32_t end_line = 0;        ///< one past the last
};

/// A side of a line.
struct FragmentCut {
  std::uint32_t line = 0;  ///< into FrameGeometry::cut_lines
  bool front = false;      ///< before the line's plane
};

/// A polygon of a shadow volume.
struct VolumeFace {
  std::uint32_t polygon = 0;  ///< into FrameGeometry::polygons; a cap is the very polygon that is drawn
  /// Factor of its winding number: -1 where the drawn polygon faces into the volume, above 1 for as many sides in one.
  std::int32_t w = 1;
};

/// A piece of the outline of a volume's near cap, its section with the plane at w0. An edge that goes down adds w to
/// the sum of all pixels right of it; an edge that goes up subtracts w.
struct NearEdge {
  ScreenVertex from;   ///< where it begins
  ScreenVertex to;     ///< where it ends
  std::int32_t w = 1;  ///< its multiplicity
};

/// A shadow volume: all that delimits it before the far end, which lies behind everything drawn. With DSF_BITS = 1 no
/// ray to the light meets two of its caps, with more at most 2^DSF_BITS - 1.
struct ShadowVolume {
  std::uint32_t first_face = 0;  ///< into FrameGeometry::volume_faces
  std::uint32_t face_count = 0;  ///< at least 1
  std::uint32_t first_near = 0;  ///< into FrameGeometry::near_edges
  std::uint32_t near_count = 0;  ///< 0: the plane at w0 does not cut it
  std::uint32_t component = 0;   ///< of its first caster, into SceneFrame::components
  std::uint32_t sample = 0;      ///< of light that it keeps out, into FrameGeometry::sample_light
};

/// An edge of a polyhedron, between two polygons. The outline of `along` has it from `from` to `to`, that of `against`
/// the other way round. A polygon that is turned away, and so not drawn, is kNoPolygon. [Ohno 1985: edge groups with
/// right and left face.]
struct PolyhedronEdge {
  /// The number of no polygon.
  static constexpr std::uint32_t kNoPolygon = ~0U;
  ScreenVertex from;                   ///< its lower vertex number
  ScreenVertex to;                     ///< its higher one
  std::uint32_t along = kNoPolygon;    ///< into FrameGeometry::polygons
  std::uint32_t against = kNoPolygon;  ///< likewise
};

/// A convex polyhedron that lies wholly from w0 on, of one colour per face. Its drawn polygons are those not turned
/// away.
struct Polyhedron {
  std::uint32_t component = 0;      ///< into SceneFrame::components
  std::uint32_t first_polygon = 0;  ///< into FrameGeometry::polygons
  std::uint32_t polygon_count = 0;  ///< those not turned away
  std::uint32_t first_edge = 0;     ///< into FrameGeometry::polyhedron_edges
  std::uint32_t edge_count = 0;     ///< those with a polygon that is drawn
};

/// Why a component is no polyhedron in a frame.
enum class SpanReason : std::uint8_t {
  none,         ///< it is one
  not_closed,   ///< Component::closed
  not_convex,   ///< Component::convex
  cut,          ///< by the plane at w0 or the guard band
  colors,       ///< more than one within a face
  translucent,  ///< a unit's pixels are opaque
  culled,       ///< Look::cull leaves out faces that the eye would see
};

/// A frame on the screen.
struct FrameGeometry {
  int width = 0;                 ///< of the picture, in pixels
  int height = 0;                ///< likewise, in lines
  std::uint32_t background = 0;  ///< channel c in bits 8c .. 8c + 7
  std::uint32_t shade = 0;       ///< darkening of a pixel by one shadowed sample, in 2^-SHADE_FRAC; without table
  /// The same by class and light: entry (class - 1) LIGHTS + light. Empty without table.
  std::vector<std::array<std::uint32_t, 3>> shares;
  std::vector<std::uint8_t> sample_light;  ///< of each light sample its light; samples of a light are consecutive
  std::vector<int> passes;                 ///< with linear light, of each light its samples
  int sub_bits = kMostSubBits;             ///< Look::sub_bits: coordinates are multiples of 2^(8 - sub_bits)
  std::vector<ScreenVertex> vertices;      ///< of all outlines
  /// First the opaque drawn ones, in draw order, then other faces of volumes, then translucent ones.
  std::vector<ScreenPolygon> polygons;
  std::uint32_t drawn = 0;  ///< number of the opaque drawn ones
  /// Value in units of an 8-bit colour, as displayed; with linear light in 1/256 of white, of a light that of a sample.
  std::vector<ScreenPlane> color_planes;
  std::vector<ShadeCut> shade_cuts;              ///< of all diced polygons
  std::vector<Shade> shades;                     ///< of all diced polygons
  std::vector<VolumeFace> volume_faces;          ///< of all volumes
  std::vector<NearEdge> near_edges;              ///< of all volumes
  std::vector<ShadowVolume> volumes;             ///< in order of their samples
  std::uint32_t left_out = 0;                    ///< volumes that Look::fit has dropped
  std::vector<Polyhedron> polyhedra;             ///< in draw order; their polygons are the first of the drawn ones
  std::vector<PolyhedronEdge> polyhedron_edges;  ///< of all polyhedra
  std::vector<SpanReason> span_reasons;          ///< of each of SceneFrame::components
  std::vector<ScreenFragment> fragments;         ///< translucent ones, back to front
  std::vector<FragmentCut> cuts;                 ///< of all fragments
  std::vector<CutLine> cut_lines;                ///< that cuts are sides of

  /// A polygon's corners.
  /// @param p one of `polygons`
  /// @return its vertices, in order
  [[nodiscard]] std::span<const ScreenVertex> outline(const ScreenPolygon& p) const {
    return std::span(vertices).subspan(p.first_vertex, p.vertex_count);
  }
};

/// Most classes of a light table.
inline constexpr int kMaxClasses = 2047;

/// How translucent faces are put in order.
enum class TranslucentWay : std::uint8_t {
  exact,       ///< by a BSP tree, cut where they must be: every pixel's layers back to front [Tanaka 2005]
  centroid,    ///< whole, by the distance of the mean of their corners along the view: what most renderers do
  submission,  ///< whole, as the file has them
};

/// Choices of the picture's maker.
struct Look {
  std::array<std::uint8_t, 3> background{38, 44, 56};  ///< as displayed: red, green, blue
  /// Share of its colour that a lit pixel loses in full shadow where there is no table, 0 .. 1; none: that of least
  /// error for the frame.
  std::optional<double> darkening;
  double extrusion = 1;   ///< volumes reach this many times as far as they must; for tests, >= 1
  bool far_ends = false;  ///< volumes carry their far ends as faces too, which changes no picture; for tests
  /// Depth begins at the camera's near plane wherever the nearest surface lies: coarser, so that surfaces close to each
  /// other may change places; for tests.
  bool depth_from_near = false;
  VolumeWay volumes = VolumeWay::fewest;  ///< how many volumes casters have
  bool leave_out = true;                  ///< shadows that can meet nothing seen, which changes no picture
  /// Makes the picture fit the configuration where make_geometry() would throw Error. A light with too many samples for
  /// COUNT_BITS becomes one sample at its middle. Without FSF one volume of each light sample stays: the first, in draw
  /// order, that meets something seen, which may be another caster's in the next frame; FrameGeometry::left_out counts
  /// the others.
  bool fit = false;
  /// Faces are not drawn if the eye sees the side that their material does not show (Sides); they cast shadows all the
  /// same.
  bool cull = false;
  TranslucentWay translucent = TranslucentWay::exact;  ///< how translucent faces are put in order
  int samples = 15;                                    ///< of an area light, 1 .. kMaxSamples; 1 without COUNT_BITS
  std::uint64_t seed = 1;                              ///< of the samples' pattern
  int classes = kMaxClasses;  ///< most that a light table is to tell apart, 1 .. kMaxClasses; fewer if it has no room
  /// With SMOOTH, a face is diced where colours between its corners are further from light at the pixel, in steps of
  /// 255: 1 .. 255. 0: none is.
  int max_shading = 2;
  /// Bits of a snapped coordinate's fraction, kLeastSubBits .. kMostSubBits: positions are rounded half up to
  /// 2^-sub_bits pixel. They stay 16.8 fixed point; below 8, their last bits are 0.
  int sub_bits = kMostSubBits;
};

/// Keeps the visibility order of a scene's translucent faces from frame to frame, so that what does not move is put in
/// a tree once. It changes no frame. Not for several threads at once.
class TranslucentOrder {
 public:
  /// Nothing is kept yet. make_geometry() throws TooManyFragments past the limit of `build`; it calls `progress` while
  /// a tree is built, and now and then, with 1, while it makes fragments of one.
  /// @param build how trees are built
  explicit TranslucentOrder(OrderBuildOptions build = {});
  ~TranslucentOrder();
  TranslucentOrder(TranslucentOrder&&) noexcept;
  TranslucentOrder& operator=(TranslucentOrder&&) noexcept;

 private:
  friend struct TranslucentOrderInside;  // how the library itself comes to what is kept
  struct Data;
  std::unique_ptr<Data> data_;
};

/// How a frame's geometry is made.
struct GeometryOptions {
  Look look = {};                     ///< what the picture's maker decides
  TranslucentOrder* order = nullptr;  ///< that of the frames before; nullptr: made anew
  ShadowCache* shadows = nullptr;     ///< likewise
};

/// How far a frame's light is off on a core, in steps of 255.
struct LightDemand {
  /// In shadow, because faces share what shadows take, and because shares of several lights are added. It is the root
  /// mean square over the faces that casters may keep light from, in the shadow of each light and of all.
  double share_error = 0;
  /// With one colour a polygon, the mean of its corners': most that light is from it, at corners and on a grid between
  /// them. A large face has a grid of 16 parts a side, so that a narrower cone may be missed.
  double color_spread = 0;
};

/// Measures the light of a frame on all of its faces, in view or not. Throws Error as make_geometry() does of the frame
/// and the look, or if a light has more samples than the configuration counts.
/// @param frame what is lit
/// @param config says how many classes a table tells apart; without a table all shadows have one share
/// @param look how
/// @return the errors, 0 where there is no light or no face
LightDemand light_demand(const SceneFrame& frame, const Config& config, const Look& look);

/// Projects, clips and snaps a frame. docs/numbers.md has every rounding with its bound; [Matsumoto] has the volumes,
/// [Ohno 1985] the polyhedra, [Tanaka 2005] the fragments. Throws Error if width or height is not 1 .. kMaxSize, if
/// there are no faces, or if a vertex, the camera, a light or the look is not as its type says. Throws Error too if a
/// light that is not at infinity is larger than 2^40 times the scene's size, or further from the scene than that.
/// Throws TooManyFragments as TranslucentOrder says.
/// @param frame what is drawn
/// @param config says how fine depth is, whether colour is grey, whether shadows are wanted, and of how many lights
/// and samples. It also says whether colour may vary within a polygon (else each polygon has the mean of its corners),
/// and whether translucent faces are blended (else they are opaque and drawn last).
/// @param width of the picture, in pixels
/// @param height of the picture, in lines
/// @param options how it is made
/// @return the frame in integers
FrameGeometry make_geometry(const SceneFrame& frame, const Config& config, int width, int height,
                            const GeometryOptions& options = {});

}  // namespace kage
