// Meshes on the graphics side, kept from frame to frame.
#pragma once
#include <map>
#include <memory>

#include "engine/frame/frame.h"
#include "render/draw_mesh.h"
#include "render/gl.h"

namespace sherd {

// One uploaded mesh. Needs a current context for its whole life.
class DrawBuffer {
 public:
  explicit DrawBuffer(const DrawMesh& mesh);
  ~DrawBuffer();
  DrawBuffer(const DrawBuffer&) = delete;
  DrawBuffer& operator=(const DrawBuffer&) = delete;

  void draw_original() const { draw(0, original_); }
  void draw_crack() const { draw(original_, total_); }
  const Vec3& origin() const { return origin_; }  // mesh coordinates of the drawn zero
  const Box& box() const { return box_; }         // mesh coordinates

 private:
  void draw(std::size_t begin, std::size_t end) const;

  Vec3 origin_;
  Box box_;
  std::size_t original_, total_;  // indices
  GLuint array_ = 0, buffers_[3] = {0, 0, 0};
};

class DrawCache {
 public:
  // The buffers of the frame's bodies, in their order; uploads new meshes and drops those no longer shown.
  std::vector<const DrawBuffer*> update(const Frame& frame);
  std::size_t size() const { return entries_.size(); }
  void clear() { entries_.clear(); }

 private:
  struct Entry {
    std::shared_ptr<const SurfaceMesh> mesh;  // held, so that a different mesh under the same key is noticed
    std::shared_ptr<const SurfaceField> field;
    std::unique_ptr<DrawBuffer> buffer;
    bool shown = false;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Entry> entries_;  // (body id, mesh version)
};

}  // namespace sherd
