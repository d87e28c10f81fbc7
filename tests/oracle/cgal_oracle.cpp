// The only file that includes CGAL (GPL): a test program, never part of the product.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <exception>

#include "tests/oracle/oracle.h"

namespace sherd {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using VertexIndex = Mesh::Vertex_index;

// False when a face cannot be added: an edge of three faces, or two faces that run through it alike.
bool convert(const SurfaceMesh& from, Mesh& to) {
  std::vector<VertexIndex> vertex;
  for (std::size_t i = 0; i < from.vertex_count(); ++i) {
    const Vec3 p = from.vertices[i];
    vertex.push_back(to.add_vertex({p.x, p.y, p.z}));
  }
  for (const Triangle& t : from.triangles)
    if (to.add_face(vertex[t[0]], vertex[t[1]], vertex[t[2]]) == Mesh::null_face()) return false;
  return true;
}

// Signed volumes of the connected surfaces, largest first: cavities are negative.
std::vector<double> component_volumes(const Mesh& mesh) {
  std::vector<Mesh> parts;
  Mesh copy = mesh;
  pmp::split_connected_components(copy, parts);
  std::vector<double> volumes;
  for (const Mesh& part : parts) volumes.push_back(CGAL::to_double(pmp::volume(part)));
  std::sort(volumes.rbegin(), volumes.rend());
  return volumes;
}

}  // namespace

OracleAnswer cgal_check(const SurfaceMesh& mesh) {
  OracleAnswer answer;
  try {
    Mesh m;
    answer.ok = true;
    if (!convert(mesh, m)) {
      answer.reason = "a face does not fit its neighbours";
      return answer;
    }
    answer.closed = CGAL::is_closed(m) && CGAL::is_valid_polygon_mesh(m);
    if (!answer.closed) return answer;
    answer.embedded = !pmp::does_self_intersect<CGAL::Sequential_tag>(m);
    answer.volumes = component_volumes(m);
  } catch (const std::exception& e) {
    answer.ok = false, answer.reason = e.what();
  }
  return answer;
}

OracleAnswer cgal_difference(const SurfaceMesh& body, const SurfaceMesh& slab) {
  OracleAnswer answer;
  try {
    Mesh a, b, out;
    if (!convert(body, a) || !convert(slab, b)) {
      answer.reason = "an operand is not manifold";
      return answer;
    }
    if (!pmp::corefine_and_compute_difference(a, b, out)) {
      answer.reason = "the difference is not manifold";
      return answer;
    }
    answer.ok = true, answer.closed = CGAL::is_closed(out);
    answer.volumes = component_volumes(out);
  } catch (const std::exception& e) {
    answer.ok = false, answer.reason = e.what();
  }
  return answer;
}

}  // namespace sherd
