#include "engine/mesh/repair.h"

#include "engine/mesh/intersections.h"
#include "engine/mesh/repair_steps.h"
#include "engine/mesh/resample.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

std::string near_text(const std::vector<Vec3>& places) {
  std::string text;
  for (std::size_t i = 0; i < places.size() && i < 3; ++i)
    text += fmt::format("{}({:.6g}, {:.6g}, {:.6g})", i == 0 ? ", first near " : ", ", places[i].x, places[i].y,
                        places[i].z);
  return text;
}

const char* plural(std::size_t n) {
  return n == 1 ? "" : "s";
}

class Repair {
 public:
  Repair(SurfaceMesh& mesh, const RepairOptions& options, Messages& messages)
      : mesh_(mesh), options_(options), messages_(messages) {}

  void run() {
    refuse_raw();
    mesh_.faces.resize(mesh_.triangle_count());
    if (needs_nothing()) return;
    tidy();
    refuse_nonmanifold_edges();
    make_oriented();
    const SurfaceMesh before = mesh_.channels.empty() ? SurfaceMesh{} : mesh_;
    const bool filled = close_holes(), thinned = remove_thin_triangles();
    // New triangles and those whose corners moved take the values of the surface they lie on.
    if (!before.channels.empty() && (filled || thinned)) resample_channels(before, mesh_);
    turn();
    if (options_.check_self_intersections) separate();
    confirm();
  }

 private:
  [[noreturn]] void refuse(const std::string& text) const {
    throw InputError(fmt::format("{}: {}", options_.name, text));
  }
  void say(const std::string& text) { messages_.push_back(text); }

  void refuse_raw() const {
    if (mesh_.triangles.empty()) refuse("no triangles; nothing to break");
    const MeshReport r = report_mesh({mesh_.vertices, {}, {}, {}});
    if (r.bad_coordinates > 0)
      refuse(fmt::format("{} vertices have a coordinate that is not finite; export the mesh again", r.bad_coordinates));
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t])
        if (v >= mesh_.vertex_count())
          refuse(fmt::format("triangle {} uses vertex {} of {}; export the mesh again", t, v, mesh_.vertex_count()));
  }
  // The common case at the cost of one look.
  bool needs_nothing() {
    const MeshReport r = report_mesh(mesh_);
    if (!is_valid(r) || r.needle_triangles > 0 || r.unused_vertices > 0) return false;
    if (options_.check_self_intersections && count_self_intersections(mesh_, 1) > 0) return false;
    mention_small_pieces(r);
    return true;
  }
  void tidy() {
    if (const std::size_t n = drop_repeated_vertex_triangles(mesh_); n > 0)
      say(fmt::format("dropped {} triangle{} with a repeated vertex", n, plural(n)));
    if (const std::size_t n = drop_unused_vertices(mesh_); n > 0)
      say(fmt::format("dropped {} {} in no triangle", n, n == 1 ? "vertex" : "vertices"));
    if (const std::size_t n = split_vertices(mesh_); n > 0)
      say(fmt::format("split {} {} where separate parts of the surface touch", n, n == 1 ? "vertex" : "vertices"));
  }
  void refuse_nonmanifold_edges() const {
    const MeshReport r = report_mesh(mesh_);
    if (r.nonmanifold_edges > 0)
      refuse(fmt::format(
          "not a surface: {} edge{} shared by more than two triangles{}; separate or unite the parts that meet "
          "there in a mesh editor",
          r.nonmanifold_edges, r.nonmanifold_edges == 1 ? " is" : "s are", near_text(r.nonmanifold_edge_places)));
  }
  void make_oriented() {
    const Orientation o = orient(mesh_);
    if (!o.conflicts.empty())
      refuse(fmt::format(
          "the surface has only one side (as a Moebius strip): {} edge{} cannot be oriented{}; it bounds no solid",
          o.conflicts.size(), plural(o.conflicts.size()), near_text(o.conflicts)));
    if (o.flipped > 0)
      say(fmt::format("turned {} triangle{} to agree with their neighbours", o.flipped, plural(o.flipped)));
  }
  bool close_holes() {
    const Real diagonal = bounding_box(mesh_).diagonal();
    const Real limit = options_.max_hole_diameter > 0 ? options_.max_hole_diameter : 0.05 * diagonal;
    const HoleFilling h = fill_holes(mesh_, limit);
    if (!h.refused.empty())
      refuse(fmt::format(
          "not closed: {} hole{} with {} border edges, the largest {:.4g} m wide, exceed the limit of {:.4g} m for "
          "closing "
          "them{}; close the mesh in an editor or raise the limit",
          h.refused.size(), plural(h.refused.size()), h.refused_edges, h.largest_refused, limit, near_text(h.refused)));
    if (h.filled > 0)
      say(fmt::format("closed {} hole{} (the largest {:.4g} m wide) with {} triangles", h.filled, plural(h.filled),
                      h.largest_filled, h.triangles));
    return h.filled > 0;
  }
  bool remove_thin_triangles() {
    const NeedleRemoval n = remove_needles(mesh_);
    if (n.flips + n.collapses > 0)
      say(fmt::format("removed thin triangles by {} edge flip{} and {} edge collapse{}", n.flips, plural(n.flips),
                      n.collapses, plural(n.collapses)));
    return n.flips + n.collapses > 0;
  }
  void turn() {
    if (const std::size_t n = turn_shells(mesh_); n > 0)
      say(fmt::format("turned {} shell{} that {} inside out", n, plural(n), n == 1 ? "was" : "were"));
  }
  void separate() {
    const Untangling u = untangle(mesh_);
    if (u.after > 0)
      refuse(fmt::format("{}{} pair{} of triangles intersect{}{}; unite or separate these parts in a mesh editor",
                         u.before >= 1000 ? "at least " : "", u.before, plural(u.before), u.before == 1 ? "s" : "",
                         near_text(u.places)));
    if (u.before > 0)
      say(fmt::format("smoothed {} pair{} of intersecting triangles apart, moving vertices by up to {:.3g} m{}",
                      u.before, plural(u.before), u.moved, near_text(u.places)));
  }
  void confirm() {
    const MeshReport r = report_mesh(mesh_);
    if (!is_valid(r)) refuse(fmt::format("cannot be made a solid:\n{}", to_text(r)));
    mention_small_pieces(r);
  }
  void mention_small_pieces(const MeshReport& r) {
    if (r.components < 2) return;
    std::vector<std::uint32_t> label;
    std::vector<std::size_t> triangles(label_components(mesh_, label), 0);
    std::vector<Box> boxes(triangles.size());
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) boxes[label[t]].grow(mesh_.corner(t, k));
    std::size_t small = 0;
    std::vector<Vec3> places;
    for (const Box& box : boxes)
      if (box.diagonal() < 0.01 * r.box.diagonal()) ++small, places.push_back(box.centre());
    if (small > 0)
      say(fmt::format("kept {} separate piece{} smaller than 1 % of the whole{}", small, plural(small),
                      near_text(places)));
  }

  SurfaceMesh& mesh_;
  const RepairOptions& options_;
  Messages& messages_;
};

}  // namespace

void repair_mesh(SurfaceMesh& mesh, const RepairOptions& options, std::vector<std::string>& messages) {
  Repair(mesh, options, messages).run();
}

}  // namespace sherd
