// Frame to picture, headless: software OpenGL 3.3 (OSMesa), no display and no graphics card needed.
//
// Light: a warm sun with soft shadows, a hemisphere of sky light darkened by screen-space ambient occlusion, a little
// gloss. Bodies are smooth within 35 degrees of dihedral angle; crack faces meet the original surface in a crease. The
// ground fades into the sky with distance. A body with opacity < 1 shows its crack faces through its original surface.
// A wireframe view has the edges of all triangles as thin dark lines where they are not hidden; of a body with opacity
// < 1 those of its original surface are fainter. A body with a field has its colours instead, with a colour bar at the
// left.
#pragma once
#include <memory>

#include "engine/frame/frame.h"
#include "render/image.h"

namespace sherd {

class Rasterizer {
 public:
  // Throws InputError when the machine's OSMesa offers no OpenGL 3.3 core context.
  Rasterizer();
  ~Rasterizer();
  Rasterizer(const Rasterizer&) = delete;
  Rasterizer& operator=(const Rasterizer&) = delete;

  // The same frame and view give the same bytes, whatever was drawn before. A mesh is uploaded once per (body id, mesh
  // version) and dropped with the first frame that does not show it. One call at a time; any thread may call.
  // Throws InputError for a view or a body that cannot be drawn (no pixels, no direction, not finite, no mesh).
  Image render(const Frame& frame, const View& view);
  // Drops what was uploaded; the pictures stay the same.
  void forget_meshes();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
