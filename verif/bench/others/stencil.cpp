// SPDX-License-Identifier: Apache-2.0
#include "bench/others/stencil.hpp"

#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>

#include <cstdlib>
#include <stdexcept>

#include "shadow/kept.hpp"

namespace kage::verif {
namespace {

// Drawn faces and caps go through the same program, so that their depths are the same bit for bit.
constexpr const char* kFaceVertex = R"(#version 330
uniform mat4 camera;
layout(location = 0) in vec3 place;
layout(location = 1) in vec4 look;
flat out vec4 color;
invariant gl_Position;
void main() { gl_Position = camera * vec4(place, 1); color = look; })";
constexpr const char* kFacePixel = R"(#version 330
flat in vec4 color;
out vec4 shown;
void main() { shown = color; })";
constexpr const char* kScreenVertex = R"(#version 330
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); })";
constexpr const char* kScreenPixel = R"(#version 330
out vec4 shown;
void main() { shown = vec4(0); })";

GLuint program(const char* vertex, const char* pixel) {
  const GLuint made = glCreateProgram();
  for (const auto& [kind, text] :
       {std::pair<GLenum, const char*>{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, pixel}}) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(made, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(made);
  GLint ok = 0;
  glGetProgramiv(made, GL_LINK_STATUS, &ok);
  if (ok == 0) throw std::runtime_error("OpenGL does not take the shaders");
  return made;
}

// From world to clip space, columns first. y goes down, so that the first line read is the top one.
std::array<float, 16> matrix(const Camera& c, double aspect, double far) {
  const double n = c.near;
  std::array<glm::dvec3, 4> row{c.right / (c.half_height * aspect), -c.up / c.half_height, c.forward, c.forward};
  std::array<double, 4> add{};
  if (c.perspective) {
    row[2] *= (far + n) / (far - n);
    add[2] = -2 * far * n / (far - n);
  } else {
    row[2] *= 2 / (far - n);
    add[2] = -(far + n) / (far - n);
    row[3] = {0, 0, 0};
    add[3] = 1;
  }
  std::array<float, 16> m{};
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t k = 0; k < 3; ++k) m[4 * k + r] = static_cast<float>(row[r][static_cast<int>(k)]);
    m[12 + r] = static_cast<float>(add[r] - glm::dot(row[r], c.eye));
  }
  return m;
}

std::array<float, 3> single(const glm::dvec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

template <class T>
void fill(GLenum target, GLuint buffer, const std::vector<T>& data) {
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STREAM_DRAW);
}

}  // namespace

void add_faces(const SceneFrame& f, Looks& looks, double darkening, StencilMesh& out) {
  out.corners.clear();
  out.colors.clear();
  out.faces.clear();
  const auto loss = static_cast<std::uint8_t>(to_fixed(255 * darkening, 0));
  for (const Component& part : f.components)
    for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
      const Polygon& face = f.polygons[i];
      if (part.closed && looks.facing(face) <= 0) continue;
      const FaceLook& look = looks[i];
      const auto first = static_cast<std::uint32_t>(out.corners.size());
      for (const std::uint32_t v : f.outline(face)) out.corners.push_back(single(f.vertices[v]));
      out.colors.resize(out.corners.size(),
                        {look.color[0], look.color[1], look.color[2], look.lit ? loss : std::uint8_t{0}});
      for (std::uint32_t k = 1; k + 1 < face.count; ++k)
        out.faces.insert(out.faces.end(), {first, first + k, first + k + 1});
    }
}

void add_volumes(const SceneFrame& f, const ShadowCaster& caster, StencilWay way, StencilMesh& out) {
  const auto n = static_cast<std::uint32_t>(f.vertices.size());
  out.places.clear();
  out.volumes.clear();
  for (const glm::dvec3& p : f.vertices) out.places.push_back(single(p));
  ShadowCache fresh;
  const std::vector<SpaceBox> boxes = component_boxes(f);
  VolumeCaster volumes(f, boxes, 8, VolumeWay::fewest, ShadowCacheInside::of(fresh));
  volumes.make(0, caster, [&](const WorldVolume& volume, std::uint32_t) {
    const auto base = static_cast<std::uint32_t>(out.places.size());
    const double factor = caster.far_factor(volume.caps);
    for (const glm::dvec3& p : f.vertices) out.places.push_back(single(caster.far_point(p, factor)));
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      out.volumes.insert(out.volumes.end(), {a, b, c});
    };
    for (const SideEdge& s : volume.sides)
      for (std::int32_t w = 0; w < s.w; ++w) {
        add(s.a, base + s.a, base + s.b);
        add(s.a, base + s.b, s.b);
      }
    if (way == StencilWay::depth_pass) return;
    for (const CapFace& cap : volume.caps) {
      const auto c = f.outline(f.polygons[cap.polygon]);
      for (std::size_t k = 1; k + 1 < c.size(); ++k) {
        // A cap has its face's corners in the same order or with the first two exchanged: llvmpipe sets both up alike.
        const std::uint32_t a = cap.turned ? c[k] : c[0];
        const std::uint32_t b = cap.turned ? c[0] : c[k];
        add(a, b, c[k + 1]);
        add(base + b, base + a, base + c[k + 1]);
      }
    }
  });
  if (out.places.size() == n) out.places.clear();
}

struct StencilRenderer::Data {
  int width = 0;
  int height = 0;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  GLuint faces = 0;  // programs
  GLuint screen = 0;
  GLint camera = -1;
  std::array<GLuint, 5> buffers{};  // corners, colours, indices of faces; places, indices of volumes
  std::array<GLuint, 3> arrays{};   // faces, volumes, nothing
  GLsizei face_count = 0;           // indices
  GLsizei volume_count = 0;

  Data(int w, int h) : width(w), height(h) {
    // Before EGL starts: software, no thread but the caller's, nothing kept on disk.
    for (const auto& [name, value] : {std::pair{"LIBGL_ALWAYS_SOFTWARE", "1"},
                                      {"GALLIUM_DRIVER", "llvmpipe"},
                                      {"LP_NUM_THREADS", "0"},
                                      {"MESA_SHADER_CACHE_DISABLE", "true"}})
      setenv(name, value, 1);
    display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE)
      throw std::runtime_error("no EGL display without a window");
    const std::array<EGLint, 3> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    const std::array<EGLint, 7> version{
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    eglBindAPI(EGL_OPENGL_API);
    // Surfaceless displays may have no configuration at all: a context needs none to draw into a framebuffer object.
    if (eglChooseConfig(display, wanted.data(), &config, 1, &found) == EGL_FALSE || found == 0) config = nullptr;
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
    if (context == EGL_NO_CONTEXT || eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
      close();
      throw std::runtime_error("no OpenGL 3.3 without a window");
    }
  }
  ~Data() { close(); }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;

  // The display is the process's own and stays.
  void close() {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    context = EGL_NO_CONTEXT;
  }
};

StencilRenderer::StencilRenderer(int width, int height) : data_(std::make_unique<Data>(width, height)) {
  Data& d = *data_;
  if (name().find("llvmpipe") == std::string::npos) throw std::runtime_error("OpenGL is not llvmpipe's: " + name());
  GLuint frame = 0;
  std::array<GLuint, 2> stores{};
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glGenRenderbuffers(2, stores.data());
  const std::array<std::array<GLenum, 2>, 2> kinds{
      {{GL_RGBA8, GL_COLOR_ATTACHMENT0}, {GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT}}};
  for (std::size_t i = 0; i < 2; ++i) {
    glBindRenderbuffer(GL_RENDERBUFFER, stores[i]);
    glRenderbufferStorage(GL_RENDERBUFFER, kinds[i][0], width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, kinds[i][1], GL_RENDERBUFFER, stores[i]);
  }
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("no framebuffer with a stencil");
  d.faces = program(kFaceVertex, kFacePixel);
  d.screen = program(kScreenVertex, kScreenPixel);
  d.camera = glGetUniformLocation(d.faces, "camera");
  glGenBuffers(5, d.buffers.data());
  glGenVertexArrays(3, d.arrays.data());
  const auto attribute = [](GLuint number, GLuint buffer, GLint size, GLenum type, GLboolean scaled) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glEnableVertexAttribArray(number);
    glVertexAttribPointer(number, size, type, scaled, 0, nullptr);
  };
  glBindVertexArray(d.arrays[0]);
  attribute(0, d.buffers[0], 3, GL_FLOAT, GL_FALSE);
  attribute(1, d.buffers[1], 4, GL_UNSIGNED_BYTE, GL_TRUE);
  glBindVertexArray(d.arrays[1]);
  attribute(0, d.buffers[3], 3, GL_FLOAT, GL_FALSE);
  glViewport(0, 0, width, height);
  glFrontFace(GL_CW);  // y goes down
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

StencilRenderer::~StencilRenderer() = default;

std::string StencilRenderer::name() const {
  return std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + ", OpenGL " +
         reinterpret_cast<const char*>(glGetString(GL_VERSION));
}

void StencilRenderer::upload(const StencilMesh& mesh) {
  Data& d = *data_;
  glBindVertexArray(d.arrays[0]);
  fill(GL_ARRAY_BUFFER, d.buffers[0], mesh.corners);
  fill(GL_ARRAY_BUFFER, d.buffers[1], mesh.colors);
  fill(GL_ELEMENT_ARRAY_BUFFER, d.buffers[2], mesh.faces);
  glBindVertexArray(d.arrays[1]);
  fill(GL_ARRAY_BUFFER, d.buffers[3], mesh.places);
  fill(GL_ELEMENT_ARRAY_BUFFER, d.buffers[4], mesh.volumes);
  d.face_count = static_cast<GLsizei>(mesh.faces.size());
  d.volume_count = static_cast<GLsizei>(mesh.volumes.size());
}

void StencilRenderer::draw(const Camera& camera, double far, const std::array<std::uint8_t, 3>& background,
                           StencilWay way, std::vector<std::uint8_t>& out) {
  Data& d = *data_;
  glUseProgram(d.faces);
  glUniformMatrix4fv(d.camera, 1, GL_FALSE, matrix(camera, static_cast<double>(d.width) / d.height, far).data());
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glClearColor(static_cast<float>(background[0]) / 255, static_cast<float>(background[1]) / 255,
               static_cast<float>(background[2]) / 255, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glBindVertexArray(d.arrays[0]);
  glDrawElements(GL_TRIANGLES, d.face_count, GL_UNSIGNED_INT, nullptr);

  // Volumes reach past both planes of the depth range; what is clamped compares as it must.
  glEnable(GL_DEPTH_CLAMP);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 0, 255);
  const bool fail = way == StencilWay::depth_fail;
  glStencilOpSeparate(GL_FRONT, GL_KEEP, fail ? GL_DECR_WRAP : GL_KEEP, fail ? GL_KEEP : GL_INCR_WRAP);
  glStencilOpSeparate(GL_BACK, GL_KEEP, fail ? GL_INCR_WRAP : GL_KEEP, fail ? GL_KEEP : GL_DECR_WRAP);
  glBindVertexArray(d.arrays[1]);
  glDrawElements(GL_TRIANGLES, d.volume_count, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_DEPTH_CLAMP);

  // Where some volume is left, colour times 1 - what its face loses.
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glStencilFunc(GL_NOTEQUAL, 0, 255);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_ONE_MINUS_DST_ALPHA);
  glUseProgram(d.screen);
  glBindVertexArray(d.arrays[2]);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);

  out.resize(static_cast<std::size_t>(d.width) * static_cast<std::size_t>(d.height) * 4);
  glReadPixels(0, 0, d.width, d.height, GL_RGBA, GL_UNSIGNED_BYTE, out.data());
  if (glGetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL reports an error");
}

}  // namespace kage::verif
