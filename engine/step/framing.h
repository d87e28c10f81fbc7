// Cameras when the scene names none.
#pragma once
#include "engine/frame/frame.h"
#include "engine/mesh/surface_mesh.h"

namespace sherd {

// Looks at `box` from the front, a little above and aside, so that it fills most of the picture.
View frame_box(const Box& box, const View& settings);

}  // namespace sherd
