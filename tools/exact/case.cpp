#include "tools/exact/case.h"

#include "kernels/core/error.h"
#include "kernels/quadrature/gauss.h"

namespace sherd::exact {
namespace {

CaseFamily plate(std::string_view name, std::vector<int> cells, Real thickness, Real q) {
  return {name, std::move(cells), [=](int k) { return harmonic_plate(k, thickness, q); }};
}

std::vector<CaseFamily> build_families() {
  return {
      {"cube", {4, 8, 16}, stretched_cube},
      {"hollow-sphere", {4, 6, 9}, [](int f) { return hollow_sphere(f); }},
      {"hollow-sphere-jittered", {4, 6, 9}, [](int f) { return hollow_sphere(f, 0.2); }},
      {"cavity", {4, 6, 9}, [](int f) { return cavity(f, 4); }},
      {"cavity-jittered", {4, 6, 9}, [](int f) { return cavity(f, 4, 0.2); }},
      {"cavity-10", {4, 6, 9}, [](int f) { return cavity(f, 10); }},
      {"rotating-sphere", {4, 7, 11}, rotating_sphere},
      {"square-torsion", {4, 6, 9}, square_torsion},
      {"circular-torsion", {2, 3, 5}, [](int m) { return circular_torsion(m, m == 2   ? 7
                                                                             : m == 3 ? 10
                                                                                      : 13); }},
      {"self-weight", {4, 6, 9}, hanging_bar},
      {"shell-0.9", {4, 5, 7}, [](int f) { return spherical_shell(f, 0.9); }},
      {"shell-0.95", {4, 6, 8}, [](int f) { return spherical_shell(f, 0.95); }},
      plate("plate-q3-0.2", {6, 8, 10}, 0.2, 3),
      plate("plate-q3-0.1", {6, 8, 10}, 0.1, 3),
      plate("plate-q3-0.05", {8, 10, 16}, 0.05, 3),
      plate("plate-q3-0.033", {8, 10, 12}, 0.033, 3),
      plate("plate-q3-0.025", {8, 10, 12}, 0.025, 3),
      plate("plate-q6-0.2", {6, 8, 10}, 0.2, 6),
      plate("plate-q6-0.05", {8, 10, 16}, 0.05, 6),
  };
}

}  // namespace

const std::vector<CaseFamily>& case_families() {
  static const std::vector<CaseFamily> families = build_families();
  return families;
}

const CaseFamily& find_family(std::string_view name) {
  std::string names;
  for (const CaseFamily& f : case_families()) {
    if (f.name == name) return f;
    names += fmt::format(" {}", f.name);
  }
  throw InputError(fmt::format("no exact case is called '{}'; choose one of:{}", name, names));
}

Load make_load(const ExactCase& c, TractionDetail detail) {
  Load load;
  load.body_force = c.body_force;
  const std::size_t triangles = c.mesh.triangle_count();
  if (detail == TractionDetail::kConstant) {
    load.face_traction.resize(triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
      const Vec3 n = normalized(c.mesh.area_normal2(t));
      Vec3 mean;
      for (const TrianglePoint& p : kGauss7)
        mean +=
            c.traction(c.mesh.corner(t, 0) * p.a + c.mesh.corner(t, 1) * p.b + c.mesh.corner(t, 2) * p.c, n) * p.weight;
      load.face_traction.set(t, mean);
    }
    return load;
  }
  load.quadratic_traction.reserve(6 * triangles);
  for (std::size_t t = 0; t < triangles; ++t) {
    const Vec3 n = normalized(c.mesh.area_normal2(t));
    for (int k = 0; k < 3; ++k) load.quadratic_traction.push_back(c.traction(c.mesh.corner(t, k), n));
    for (int k = 0; k < 3; ++k)
      load.quadratic_traction.push_back(c.traction((c.mesh.corner(t, k) + c.mesh.corner(t, (k + 1) % 3)) * 0.5, n));
  }
  return load;
}

}  // namespace sherd::exact
