// Iterations to 1e-6 under a smooth pressure patch held by inertia relief.
#include "engine/body/mass.h"
#include "engine/mesh/shapes.h"
#include "tools/bench/stress.h"
#include "tools/exact/meshes.h"

namespace sherd::bench {
namespace {

struct IterationBody {
  const char* name;
  SurfaceMesh mesh;
};

std::vector<IterationBody> bodies() {
  return {{"sphere", exact::jittered_sphere(1, 8, 0.2, 1)},
          {"cube", exact::jittered_box({1, 1, 1}, 8, 0.2)},
          {"hollow sphere", exact::jittered_hollow_sphere(1, 0.8, 4, 0.2)},
          {"plate 20:1", exact::jittered_box({1, 1, 0.05}, 14, 0.2)},
          {"plate 100:1", exact::jittered_box({1, 1, 0.01}, 14, 0.2)}};
}

// Pressure exp(-|x - top|^2 / (2 s^2)), s = a quarter of the box, with the rigid-motion body force that balances it.
Load pressure_patch(const SurfaceMesh& mesh) {
  const Box box = bounding_box(mesh);
  const Vec3 top{box.centre().x + 0.1, box.centre().y + 0.05, box.high.z};
  const Real s2 = 0.0625 * (box.high.x - box.low.x) * (box.high.x - box.low.x);
  const MassProperties mass = mass_properties(mesh, 1);
  Load load;
  load.face_traction.resize(mesh.triangle_count());
  Vec3 force, moment;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 n2 = mesh.area_normal2(t), x = mesh.centroid(t);
    const Vec3 traction = normalized(n2) * -std::exp(-distance2(x, top) / (2 * s2));
    load.face_traction.set(t, traction);
    force += traction * (0.5 * norm(n2)), moment += cross(x - mass.centre, traction) * (0.5 * norm(n2));
  }
  load.body_force.origin = mass.centre;
  load.body_force.constant = force * (-1 / mass.volume);
  load.body_force.linear = cross_matrix(inverse(mass.inertia) * moment) * (-mass.mass / mass.volume);
  return load;
}

}  // namespace

std::vector<IterationRow> measure_iterations(exact::Formulation formulation, const exact::SolveOptions& options) {
  std::vector<IterationRow> rows;
  exact::SolveOptions own = options;
  own.formulation = formulation;
  own.elastic.krylov.tolerance = 1e-6;
  for (const IterationBody& body : bodies())
    for (const Real nu : {0.1, 0.3, 0.45, 0.49}) {
      const exact::Solved s = exact::solve(body.mesh, Elastic{1, nu}, pressure_patch(body.mesh), own);
      rows.push_back({body.name, formulation, body.mesh.triangle_count(), nu, s.ok, s.krylov.iterations,
                      s.krylov.products, s.seconds.assemble, s.seconds.solve});
    }
  return rows;
}

}  // namespace sherd::bench
