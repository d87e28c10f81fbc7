// The solids a body falls into after a cut, found by walking only the smaller sides of it.
#pragma once
#include "engine/fragment/carving.h"

namespace sherd {

// A connected component of the surface after the cut.
struct CutShell {
  std::vector<std::uint32_t> parts;  // new faces, ascending
  std::vector<std::uint32_t> whole;  // body faces walked over, ascending
  std::vector<std::uint32_t> rest;   // shells of the body: their faces that no other component has
  std::size_t faces = 0;             // of all three
  Real volume = 0;                   // m^3, negative for a cavity
};

struct CutSolid {
  std::vector<std::uint32_t> shells;  // the outer one, then its cavities
  std::size_t faces = 0;
  Real volume = 0;  // m^3
};

struct Components {
  std::string reason;  // when not empty, the rest is not to be used
  std::vector<CutShell> shells;
  std::vector<CutSolid> solids;  // largest volume first
  std::int64_t euler = 0;        // of the whole surface, as CutBody::euler()
};

// Slivers whose rounded volume is not positive belong to no solid.
Components find_components(const Carving& carving);

// A solid as a mesh of its own. Faces: the body's in their order, parts in place of their parent, then the slab's;
// vertices: the body's in their order, then the slab's, then crossings.
SurfaceMesh extract_solid(const Carving& carving, const Components& components, const CutSolid& solid);

}  // namespace sherd
