// Judges that are not ours: CGAL (exact kernel), and Manifold through Node.js. Test-only.
#pragma once
#include <string>
#include <vector>

#include "engine/mesh/surface_mesh.h"

namespace sherd {

struct OracleAnswer {
  bool ok = false;              // the oracle came to an answer
  std::string reason;           // why not
  bool closed = false;          // a closed, oriented 2-manifold
  bool embedded = false;        // without self-intersections
  std::vector<double> volumes;  // of the connected surfaces, m^3, largest first; a cavity's is negative
};

// Is the mesh closed and embedded, and what does it bound?
OracleAnswer cgal_check(const SurfaceMesh& mesh);
// Body minus slab by CGAL's corefinement; `embedded` is left out.
OracleAnswer cgal_difference(const SurfaceMesh& body, const SurfaceMesh& slab);

// Whether Node.js and manifold-3d are there (tools/setup --oracles).
bool manifold_available(std::string& why_not);
// body minus slab, or the body alone where there is no slab.
struct MeshPair {
  const SurfaceMesh* body = nullptr;
  const SurfaceMesh* slab = nullptr;
};
// An answer for each pair, by one run of Node.js. Manifold keeps coordinates in single precision, so volumes agree to
// about 1e-6 of the body's; it does not look for self-intersections: `embedded` is left out. closed: the body, as
// given, is an oriented 2-manifold.
std::vector<OracleAnswer> manifold_difference(const std::vector<MeshPair>& pairs);

}  // namespace sherd
