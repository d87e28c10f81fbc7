#include "engine/mesh/remesh.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <queue>

#include "engine/mesh/attributes.h"
#include "engine/mesh/intersections.h"
#include "engine/mesh/remesh_part.h"
#include "engine/mesh/remesh_work.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

void check(const SurfaceMesh& in, const RemeshOptions& o) {
  if (!(o.edge_length > 0) || !std::isfinite(o.edge_length))
    throw InputError(fmt::format("remesh: edge_length is {}; give a positive length in metres", o.edge_length));
  if (!(o.feature_angle > 0 && o.feature_angle <= 180))
    throw InputError(fmt::format("remesh: feature_angle is {}; give degrees in (0, 180]", o.feature_angle));
  if (o.iterations < 0) throw InputError(fmt::format("remesh: iterations is {}; give 0 or more", o.iterations));
  if (!(o.merge >= 0 && o.merge <= 0.5))
    throw InputError(fmt::format("remesh: merge is {}; give a part of the target length from 0 to 0.5", o.merge));
  if (!(o.pinch_below >= 0))
    throw InputError(fmt::format("remesh: pinch_below is {}; give 0 (off) or degrees", o.pinch_below));
  if (!o.locked.empty() && o.locked.size() != in.vertex_count())
    throw InputError(fmt::format("remesh: {} lock flags for {} vertices; give none or one each", o.locked.size(),
                                 in.vertex_count()));
  if (!o.size.empty() && o.size.size() != in.vertex_count())
    throw InputError(fmt::format("remesh: {} target lengths for {} vertices; give none or one each", o.size.size(),
                                 in.vertex_count()));
  for (const Real size : o.size)
    if (!(size > 0) || !std::isfinite(size))
      throw InputError(fmt::format("remesh: a target length is {}; give positive lengths in metres", size));
}

// Each face takes `source`, `side` and corner values from the input faces it lies on.
void inherit(const SurfaceMesh& in, const Remesher& work, const std::vector<std::uint32_t>& faces_of, SurfaceMesh& out,
             Real h, RemeshReport& report) {
  const ChannelSampler sampler(in, work.input());
  match_channels(in, out);
  for (CornerChannel& c : out.channels) c.value.clear();
  Real deviation2 = 0, face_deviation2 = 0;
  for (std::uint32_t t = 0; t < out.triangle_count(); ++t) {
    if (work.untouched(faces_of[t])) {
      copy_corners(in, faces_of[t], out);
      continue;
    }
    face_deviation2 = std::max(face_deviation2, work.input().closest(out.centroid(t)).distance2);
    const Vec3 n = normalized(out.area_normal2(t));
    const std::uint32_t region = work.mesh().region[faces_of[t]];
    auto found = work.project(out.centroid(t), n, region);
    if (!found) found = work.project(out.centroid(t), {}, region);
    const std::uint32_t face = found ? found->face : work.input().closest(out.centroid(t)).face;
    if (found) out.faces.source[t] = in.faces.source[face], out.faces.side[t] = in.faces.side[face];
    sampler.append(face, {out.corner(t, 0), out.corner(t, 1), out.corner(t, 2)}, out);
  }
  for (std::size_t v = 0; v < out.vertex_count(); ++v)
    deviation2 = std::max(deviation2, work.input().closest(out.vertices[v]).distance2);
  report.max_deviation = std::sqrt(deviation2) / h;
  report.max_face_deviation = std::sqrt(face_deviation2) / h;
}

void measure(const SurfaceMesh& in, const SurfaceMesh& out, RemeshReport& report) {
  Real smallest = std::numbers::pi, input_smallest = std::numbers::pi;
  const Real degree = std::numbers::pi / 180;
  for (std::size_t t = 0; t < in.triangle_count(); ++t) {
    const Real a = smallest_angle({in.corner(t, 0), in.corner(t, 1), in.corner(t, 2)});
    input_smallest = std::min(input_smallest, a);
    report.input_below_15 += a < 15 * degree;
  }
  report.input_min_angle = input_smallest / degree;
  for (std::size_t t = 0; t < out.triangle_count(); ++t) {
    const Real a = smallest_angle({out.corner(t, 0), out.corner(t, 1), out.corner(t, 2)});
    smallest = std::min(smallest, a);
    report.below_15 += a < 15 * degree;
    report.below_1 += a < degree;
  }
  report.min_angle = smallest / degree;
  const Real volume = signed_volume(in);
  report.volume_change = volume != 0 ? (signed_volume(out) - volume) / volume : 0;
}

// Remeshes a closed mesh whose faces from `faces` on are ghosts; what is wrong with it, or "".
std::string work_on(const SurfaceMesh& mesh, std::size_t faces, const RemeshOptions& options, RemeshedPart& result,
                    RemeshReport& report) {
  EditMesh edit;
  const char* why = nullptr;
  if (!edit.assign(mesh, why)) return why;
  Remesher work(mesh, faces, std::move(edit), options, report);
  work.run();
  std::vector<std::uint32_t> faces_of;
  result.mesh = work.mesh().extract(&faces_of, &result.vertex_of);
  for (std::uint32_t& v : result.vertex_of)
    if (v >= mesh.vertex_count()) v = kNone;
  inherit(mesh, work, faces_of, result.mesh, options.edge_length, report);
  return {};
}

// Faces from `first` on that meet each other, or "": each operation tested its faces, this tests the outcome.
std::string intersections_from(const SurfaceMesh& mesh, std::size_t first) {
  SurfaceMesh changed;
  changed.vertices = mesh.vertices;
  changed.triangles.assign(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first), mesh.triangles.end());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> examples;
  if (count_self_intersections(changed, 1, &examples) == 0) return {};
  const Vec3 at = changed.centroid(examples[0].first);
  return fmt::format("faces intersect near ({:.6g}, {:.6g}, {:.6g}); does the input intersect itself there?", at.x,
                     at.y, at.z);
}

}  // namespace

std::vector<std::uint8_t> lock_good_regions(const SurfaceMesh& mesh, Real edge_length, Real distance_limit) {
  return lock_good_regions(mesh, std::vector<Real>(mesh.vertex_count(), edge_length), distance_limit);
}

std::vector<std::uint8_t> lock_good_regions(const SurfaceMesh& mesh, const std::vector<Real>& size,
                                            Real distance_limit) {
  SHERD_CHECK(size.size() == mesh.vertex_count(), "{} target lengths for {} vertices", size.size(),
              mesh.vertex_count());
  constexpr Real kPoor = 15 * std::numbers::pi / 180;
  const std::size_t n = mesh.vertex_count();
  std::vector<Real> away(n, std::numeric_limits<Real>::infinity());
  // Dijkstra along edges from the corners of poor faces.
  using Entry = std::pair<Real, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<std::uint32_t> first(n + 1, 0), neighbour(3 * mesh.triangle_count());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++first[v + 1];
  for (std::size_t v = 0; v < n; ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> fill(first.begin(), first.end() - 1);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    bool poor = smallest_angle({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}) < kPoor;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Real length = distance(mesh.corner(t, k), mesh.corner(t, (k + 1) % 3));
      const Real target = 0.5 * (size[mesh.triangles[t][i]] + size[mesh.triangles[t][(i + 1) % 3]]);
      poor = poor || length < 0.5 * target || length > 1.6 * target;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      neighbour[fill[v]++] = mesh.triangles[t][(k + 1) % 3];
      if (poor && away[v] > 0) away[v] = 0, queue.emplace(0, v);
    }
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > away[v]) continue;
    for (std::uint32_t i = first[v]; i < first[v + 1]; ++i) {
      const std::uint32_t w = neighbour[i];
      const Real dw = d + distance(mesh.vertices[v], mesh.vertices[w]);
      if (dw <= distance_limit && dw < away[w]) away[w] = dw, queue.emplace(dw, w);
    }
  }
  std::vector<std::uint8_t> locked(n);
  for (std::size_t v = 0; v < n; ++v) locked[v] = away[v] > distance_limit ? 1 : 0;
  return locked;
}

RemeshReport remesh(const SurfaceMesh& in, const RemeshOptions& options, SurfaceMesh& out) {
  check(in, options);
  RemeshReport report;
  const auto refuse = [&](std::string reason) {
    report.reason = std::move(reason);
    out = in;
    return report;
  };
  if (in.triangles.empty()) return refuse("the mesh has no triangles");
  for (const Triangle& t : in.triangles)
    if (std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return v >= in.vertex_count(); }))
      return refuse("a triangle has an invalid vertex");
  SurfaceMesh source = in;
  source.faces.resize(in.triangle_count());
  std::optional<MeshPart> part;
  if (!options.locked.empty()) part = cut_out_part(source, options);
  RemeshedPart result;
  const std::string wrong = part ? work_on(part->mesh, part->faces, part->options, result, report)
                                 : work_on(source, source.triangle_count(), options, result, report);
  if (!wrong.empty()) return refuse(wrong);
  std::size_t first_new = 0;
  SurfaceMesh whole = part ? put_back(source, *part, result, first_new) : std::move(result.mesh);
  if (const std::string meeting = intersections_from(whole, first_new); !meeting.empty()) return refuse(meeting);
  measure(source, whole, report);
  report.status = RemeshStatus::kOk;
  out = std::move(whole);
  return report;
}

}  // namespace sherd
