// `sherd stress` from outside: exact solutions through files, the formats, and every refusal.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/mesh/shapes.h"
#include "engine/mesh/write.h"
#include "tests/command/command.h"

namespace sherd::test {
namespace {

using Row = std::array<Real, 7>;  // max_principal, sxx, syy, szz, sxy, syz, szx

class Stress : public Command {
 protected:
  // Vertices of b shifted, faces after those of a.
  static SurfaceMesh both(SurfaceMesh a, const SurfaceMesh& b, const Vec3& shift) {
    const auto offset = static_cast<std::uint32_t>(a.vertex_count());
    for (std::size_t v = 0; v < b.vertex_count(); ++v) a.vertices.push_back(b.vertices[v] + shift);
    for (const Triangle& t : b.triangles) a.add_triangle(t[0] + offset, t[1] + offset, t[2] + offset);
    return a;
  }
  static SurfaceMesh turned(SurfaceMesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
  }
  void put_mesh(const SurfaceMesh& mesh, const std::string& name = "mesh.ply") const {
    write_ply(mesh, (folder_ / name).string(), PlyPrecision::kDouble);
  }
  // Tractions t(face) in T.csv, 17 digits.
  template <class F>
  void put_tractions(const SurfaceMesh& mesh, const F& traction, const std::string& name = "T.csv") const {
    std::string text = "face,tx,ty,tz\n";
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const Vec3 v = traction(t);
      if (norm2(v) > 0) text += fmt::format("{},{:.17g},{:.17g},{:.17g}\n", t, v.x, v.y, v.z);
    }
    write(name, text);
  }
  // A unit cube under the uniform tension 2 along y: sigma_yy = 2, all else 0.
  SurfaceMesh put_cube(Real scale = 1) const {
    SurfaceMesh cube = make_box({scale, scale, scale}, 0.34 * scale);
    put_mesh(cube);
    put_tractions(cube, [&](std::size_t t) { return Vec3{0, 2 * normalized(cube.area_normal2(t)).y, 0}; });
    return cube;
  }
  static constexpr const char* kFiles = "mesh.ply --traction T.csv --points P.csv --out OUT.csv --json STATS.json";
  static constexpr const char* kGlass = " --young 7e10 --poisson 0.25";
  Outcome stress(const std::string& more = "") const { return sherd("stress " + std::string(kFiles) + kGlass + more); }

  std::map<std::string, Row> results(const std::string& name = "OUT.csv") const {
    std::istringstream in(read(folder_ / name));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "id,max_principal,sxx,syy,szz,sxy,syz,szx");
    std::map<std::string, Row> rows;
    while (std::getline(in, line)) {
      std::istringstream fields(line);
      std::string id, field;
      std::getline(fields, id, ',');
      Row row{};
      for (Real& v : row) std::getline(fields, field, ','), v = std::stod(field);
      rows[id] = row;
    }
    return rows;
  }
  nlohmann::json statistics() const { return nlohmann::json::parse(read(folder_ / "STATS.json")); }
  void expect_refused(const std::string& part, const std::string& more = "") const {
    const Outcome o = stress(more);
    EXPECT_EQ(o.code, 2) << part << ": " << o.errors;
    EXPECT_NE(o.errors.find(part), std::string::npos) << "wanted '" << part << "', got: " << o.errors;
    EXPECT_FALSE(fs::exists(folder_ / "OUT.csv")) << part;
  }
};

// The displacement is affine, for which the formulation is exact; what remains is the far field's quadrature (1e-6 a
// panel) and the tolerance.
constexpr Real kExact = 1e-4;

void expect_stress(const Row& row, const Row& exact, Real tolerance) {
  for (std::size_t k = 0; k < row.size(); ++k) EXPECT_NEAR(row[k], exact[k], tolerance) << "column " << k;
}

TEST_F(Stress, TensionOfACubeIsUniformOnTheSurfaceAndInside) {
  const SurfaceMesh cube = put_cube();
  std::string points = "x,face,nx,y,z,id\n";  // any order, more columns
  for (std::size_t t = 0; t < cube.triangle_count(); t += 7) {
    const Vec3 c = cube.centroid(t);
    points += fmt::format("{:.17g},{},9,{:.17g},{:.17g},s{}\n", c.x, t, c.y, c.z, t);
  }
  points += "0.1,-1,9,0.2,-0.3,inside\r\n\r\n0.1,-1,9,0.49,-0.3,near the top\r\n";
  write("P.csv", points);
  const Outcome o = stress();
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_EQ(o.errors, "");
  const auto rows = results();
  EXPECT_EQ(rows.size(), (cube.triangle_count() + 6) / 7 + 2);
  EXPECT_TRUE(rows.contains("s14") && rows.contains("near the top"));
  for (const auto& [id, row] : rows) expect_stress(row, {2, 0, 2, 0, 0, 0, 0}, 2 * kExact);
  const auto s = statistics();
  EXPECT_EQ(s.at("triangles"), cube.triangle_count());
  EXPECT_EQ(s.at("unknowns"), 3 * cube.vertex_count());
  EXPECT_GT(s.at("iterations"), 0);
  EXPECT_LE(s.at("residual"), 1e-6);
  EXPECT_LT(s.at("net_force_residual"), 1e-15);
  EXPECT_EQ(s.at("warnings").size(), 0u);
  EXPECT_GT(s.at("peak_memory_bytes"), 1000000u);
  for (const char* stage : {"load", "check", "assemble", "solve", "recover", "evaluate", "total"})
    EXPECT_TRUE(s.at("seconds").contains(stage)) << stage;
}

TEST_F(Stress, RefinementKeepsThePolyhedronAndTheFaceNumbers) {
  const SurfaceMesh cube = put_cube();
  const Vec3 p = 0.7 * cube.corner(5, 0) + 0.2 * cube.corner(5, 1) + 0.1 * cube.corner(5, 2);
  write("P.csv", fmt::format("x,y,z,face\n{:.17g},{:.17g},{:.17g},5\n0,0,0,-1\n", p.x, p.y, p.z));
  ASSERT_EQ(stress(" --refine 1").code, 0);
  for (const auto& [id, row] : results()) expect_stress(row, {2, 0, 2, 0, 0, 0, 0}, 2 * kExact);
  EXPECT_EQ(statistics().at("triangles"), 4 * cube.triangle_count());
}

TEST_F(Stress, MillimetresAndKilometresGiveTheSameStress) {
  std::vector<std::map<std::string, Row>> all;
  for (const Real scale : {1e-3, 1.0, 1e3}) {
    // Bent by tractions linear along the end faces, so that the stress is not uniform.
    const SurfaceMesh bar = make_bar(2 * scale, scale, scale, 0.34 * scale);
    put_mesh(bar);
    put_tractions(bar, [&](std::size_t t) {
      return Vec3{bar.centroid(t).y / scale * normalized(bar.area_normal2(t)).x, 0, 0};
    });
    std::string points = "x,y,z\n";
    for (const Vec3& p : {Vec3{0.1, 0.2, 0.3}, Vec3{-0.6, -0.4, 0.1}, Vec3{0.9, 0.45, -0.2}})
      points += fmt::format("{:.17g},{:.17g},{:.17g}\n", p.x * scale, p.y * scale, p.z * scale);
    write("P.csv", points);
    ASSERT_EQ(stress().code, 0);
    all.push_back(results());
  }
  // Every step is homogeneous in the length, so only roundings differ; the solver multiplies them by its condition.
  for (std::size_t i : {0u, 2u})
    for (const auto& [id, row] : all[1]) expect_stress(all[i].at(id), row, 1e-9);
}

TEST_F(Stress, StressDoesNotDependOnTheModulus) {
  put_cube();
  write("P.csv", "x,y,z\n0.1,0.2,0.3\n");
  for (const char* young : {"1e3", "1e12"}) {
    ASSERT_EQ(sherd(std::string("stress ") + kFiles + " --poisson 0.25 --young " + young).code, 0) << young;
    expect_stress(results().at("0"), {2, 0, 2, 0, 0, 0, 0}, 2 * kExact);
  }
}

TEST_F(Stress, BodiesOfOneFileAreSolvedOneByOne) {
  const SurfaceMesh cube = make_box({1, 1, 1}, 0.5), two = both(cube, cube, {3, 0, 0});
  put_mesh(two);
  const std::size_t n = cube.triangle_count();
  put_tractions(two, [&](std::size_t t) {
    const Vec3 normal = normalized(two.area_normal2(t));
    return t < n ? Vec3{normal.x, 0, 0} : Vec3{0, 0, -4 * normal.z};
  });
  const Vec3 c = two.centroid(n + 1);
  write("P.csv",
        fmt::format("id,face,x,y,z\na,-1,0,0.1,0\nb,-1,3,0.1,0\nc,{},{:.17g},{:.17g},{:.17g}\n", n + 1, c.x, c.y, c.z));
  ASSERT_EQ(stress().code, 0);
  const auto rows = results();
  expect_stress(rows.at("a"), {1, 1, 0, 0, 0, 0, 0}, kExact);
  expect_stress(rows.at("b"), {0, 0, 0, -4, 0, 0, 0}, 4 * kExact);
  expect_stress(rows.at("c"), {0, 0, 0, -4, 0, 0, 0}, 4 * kExact);
  EXPECT_EQ(statistics().at("solids").size(), 2u);
}

TEST_F(Stress, PressureOnBothSidesOfAHollowBoxIsHydrostatic) {
  const SurfaceMesh shell = both(make_box({2, 2, 2}, 0.5), turned(make_box({1, 1, 1}, 0.5)), {0.1, 0, 0});
  put_mesh(shell);
  put_tractions(shell, [&](std::size_t t) { return normalized(shell.area_normal2(t)) * -3.0; });
  write("P.csv", "x,y,z\n0,0.75,0\n0.9,-0.9,0.3\n");
  ASSERT_EQ(stress().code, 0);
  for (const auto& [id, row] : results()) expect_stress(row, {-3, -3, -3, -3, 0, 0, 0}, 3 * kExact);
  EXPECT_EQ(statistics().at("solids").at(0).at("shells"), 2);
  // The hole is outside of the solid.
  fs::remove(folder_ / "OUT.csv");
  write("P.csv", "id,x,y,z\nfine,0,0.75,0\nhole,0,0,0\n");
  expect_refused("P.csv: point hole (0, 0, 0) lies outside of every solid");
}

TEST_F(Stress, AnUnbalancedLoadIsReportedAndCarriedByInertia) {
  // Pulled at one end alone the bar accelerates: sigma_xx grows linearly from the free end (rod in flight).
  const SurfaceMesh bar = make_bar(4, 1, 1, 0.34);
  put_mesh(bar);
  put_tractions(bar, [&](std::size_t t) { return normalized(bar.area_normal2(t)).x > 0.5 ? Vec3{2, 0, 0} : Vec3{}; });
  write("P.csv", "x,y,z\n0,0,0\n1,0.1,0.2\n-1,0.3,0.1\n");
  const Outcome o = stress();
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(o.errors.find("does not balance"), std::string::npos) << o.errors;
  const auto s = statistics();
  EXPECT_NEAR(s.at("net_force_residual"), 1, 1e-12);  // 2 Pa on 1 m^2, and nothing against it
  EXPECT_NEAR(s.at("solids").at(0).at("net_force").at(0), 2, 1e-12);
  EXPECT_EQ(s.at("warnings").size(), 1u);
  const auto rows = results();
  // Quadratic displacement: 2 % is twice what linear elements err on a bar under its weight at this resolution.
  for (const auto& [id, x] : {std::pair{"0", 0.0}, {"1", 1.0}, {"2", -1.0}})
    expect_stress(rows.at(id), {2 * (x + 2) / 4, 2 * (x + 2) / 4, 0, 0, 0, 0, 0}, 0.04);
}

TEST_F(Stress, FormatsAgreeFaceByFace) {
  const SurfaceMesh cube = put_cube();
  write_obj(cube, (folder_ / "mesh.obj").string());
  std::string off = fmt::format("OFF # a cube\n{} {} 0\n\n", cube.vertex_count(), cube.triangle_count()), stl(80, ' ');
  for (std::size_t v = 0; v < cube.vertex_count(); ++v)
    off += fmt::format("{:.17g} {:.17g} {:.17g}\n", cube.vertices.x[v], cube.vertices.y[v], cube.vertices.z[v]);
  const auto append = [&](const auto& v) { stl.append(reinterpret_cast<const char*>(&v), sizeof v); };
  append(static_cast<std::uint32_t>(cube.triangle_count()));
  for (std::size_t t = 0; t < cube.triangle_count(); ++t) {
    off += fmt::format("3 {} {} {} 255 0 0\n", cube.triangles[t][0], cube.triangles[t][1], cube.triangles[t][2]);
    for (int k = 0; k < 3; ++k) append(0.0f);
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) append(static_cast<float>(cube.corner(t, k)[a]));
    append(std::uint16_t{0});
  }
  write("mesh.off", off), write("mesh.stl", stl);
  const Vec3 c = cube.centroid(17);
  write("P.csv", fmt::format("x,y,z,face\n{:.17g},{:.17g},{:.17g},17\n0,0.1,0,-1\n", c.x, c.y, c.z));
  for (const char* name : {"mesh.obj", "mesh.off", "mesh.stl"}) {
    const Outcome o =
        sherd(fmt::format("stress {} --traction T.csv --points P.csv --out {}.csv{}", name, name, kGlass));
    ASSERT_EQ(o.code, 0) << o.errors;
    for (const auto& [id, row] : results(std::string(name) + ".csv"))
      expect_stress(row, {2, 0, 2, 0, 0, 0, 0}, 2 * kExact);
  }
}

TEST_F(Stress, TheIndirectFormulationHasAnUnknownVectorATriangle) {
  // A sphere under pressure: the density is uniform but for the polyhedron's facets, whose kinks (17 degrees) are no
  // small share of it. Half of that, 8 %, separates a working chain from wrong signs, factors or faces.
  const SurfaceMesh ball = make_sphere(1, 0.3);
  put_mesh(ball);
  put_tractions(ball, [&](std::size_t t) { return normalized(ball.area_normal2(t)) * -2.0; });
  write("P.csv", "x,y,z\n0,0,0\n0.2,0.3,0.4\n");
  ASSERT_EQ(stress(" --formulation indirect").code, 0);
  for (const auto& [id, row] : results()) expect_stress(row, {-2, -2, -2, -2, 0, 0, 0}, 0.16);
  EXPECT_EQ(statistics().at("unknowns"), 3 * ball.triangle_count());
  EXPECT_EQ(statistics().at("formulation"), "indirect");
}

TEST_F(Stress, ResultsHaveTheSameBytesForAnyNumberOfThreads) {
  put_cube();
  write("P.csv", "x,y,z\n0.1,0.2,0.3\n-0.3,0.1,0.45\n");
  ASSERT_EQ(stress(" --threads 1").code, 0);
  const std::string one = read(folder_ / "OUT.csv");
  ASSERT_EQ(stress(" --threads 3").code, 0);
  EXPECT_EQ(read(folder_ / "OUT.csv"), one);
}

TEST_F(Stress, TablesThatDoNotFitAreRefusedWithTheirLine) {
  put_cube();
  const std::string tractions = read(folder_ / "T.csv"), points = "x,y,z\n0,0,0\n";
  write("P.csv", points);
  const std::pair<const char*, const char*> bad_tractions[] = {
      {"", "T.csv: the file is empty"},
      {"face,tx,ty\n1,0,0\n", "T.csv: no column 'tz'"},
      {"face,tx,ty,tz,tx\n", "two columns are named 'tx'"},
      {"face,tx,ty,tz\n1,0,0,0\n2,0,0\n", "T.csv:3: 3 fields where the header has 4"},
      {"face,tx,ty,tz\n1,0,nan,0\n", "T.csv:2: ty: 'nan' is not finite"},
      {"face,tx,ty,tz\n1,0,abc,0\n", "T.csv:2: ty: 'abc' is no number"},
      {"face,tx,ty,tz\n\n100000,0,0,0\n", "T.csv:3: face 100000 does not exist"},
      {"face,tx,ty,tz\n-1,0,0,0\n", "T.csv:2: face -1 does not exist"},
      {"face,tx,ty,tz\n1.5,0,0,0\n", "T.csv:2: face: '1.5' is no whole number"},
      {"face,tx,ty,tz\n1,0,0,0\n1,0,0,0\n", "T.csv:3: face 1 has a traction in an earlier line"}};
  for (const auto& [text, part] : bad_tractions) write("T.csv", text), expect_refused(part);
  write("T.csv", tractions);
  const std::pair<const char*, const char*> bad_points[] = {
      {"x,y\n0,0\n", "P.csv: no column 'z'"},
      {"x,y,z\n0,inf,0\n", "P.csv:2: y: 'inf' is not finite"},
      {"x,y,z,face\n0,0,0,-2\n", "P.csv:2: face -2 does not exist"},
      {"x,y,z,face\n0,0,0,3\n", "P.csv: point 0 (0, 0, 0) lies 0.527 m off face 3"},
      {"id,x,y,z\n7,0,0,0\n8,0,9,0\n", "P.csv: point 8 (0, 9, 0) lies outside of every solid"}};
  for (const auto& [text, part] : bad_points) write("P.csv", text), expect_refused(part);
}

TEST_F(Stress, OptionsOutOfRangeAreRefused) {
  put_cube();
  write("P.csv", "x,y,z\n0,0,0\n");
  expect_refused("--body-force 1,2: 2 numbers", " --body-force 1,2");
  expect_refused("'nan' is no finite number", " --body-force 1,2,nan");
  expect_refused("refine -1 is not allowed", " --refine -1");
  expect_refused("a feature angle of 190 degrees", " --feature-angle 190");
  expect_refused("a tolerance of 0 is not allowed", " --tolerance 0");
  expect_refused("formulation", " --formulation both");
  const std::string files = std::string("stress ") + kFiles;
  for (const auto& [material, part] : {std::pair{" --young 0 --poisson 0.3", "--young 0: must be positive"},
                                       {" --young nan --poisson 0.3", "--young nan: must be positive"},
                                       {" --young 1 --poisson 0.5", "--poisson 0.5: must lie above -1 and below 0.5"},
                                       {" --young 1 --poisson -1", "--poisson -1: must lie above -1"},
                                       {" --young 1 --poisson 0.49995", "Poisson's ratio 0.49995 is not allowed"},
                                       {" --young 1", "--poisson is required"}}) {
    const Outcome o = sherd(files + material);
    EXPECT_EQ(o.code, 2) << material;
    EXPECT_NE(o.errors.find(part), std::string::npos) << o.errors;
  }
  const std::string before = read(folder_ / "P.csv");
  EXPECT_EQ(sherd("stress mesh.ply --traction T.csv --points P.csv --out P.csv --young 1 --poisson 0.3").code, 2);
  EXPECT_EQ(read(folder_ / "P.csv"), before) << "results replaced an input";
}

TEST_F(Stress, MeshesThatBoundNoSolidAreRefusedWithTheReason) {
  const SurfaceMesh cube = make_box({1, 1, 1}, 0.5), small = make_box({0.3, 0.3, 0.3}, 0.3);
  write("T.csv", "face,tx,ty,tz\n");
  write("P.csv", "x,y,z\n");
  const auto refused = [&](const SurfaceMesh& mesh, const std::string& part) {
    put_mesh(mesh), expect_refused("mesh.ply: " + part);
  };
  SurfaceMesh open = cube;
  open.triangles.pop_back(), open.faces = {}, open.faces.resize(open.triangles.size());
  refused(open, "the surface is open: 3 border edges");
  refused(turned(cube), "the closed surface of face 0 is oriented inwards");
  refused(both(cube, turned(small), {2, 0, 0}),
          fmt::format("the closed surface of face {} is oriented inwards: a solid turned inside out, or a cavity that "
                      "lies in no solid",
                      cube.triangle_count()));
  refused(both(cube, small, {}),
          fmt::format("the closed surface of face {} lies inside another solid", cube.triangle_count()));
  refused(both(cube, small, {0.5, 0.1, 0.1}), "the surface touches or crosses itself");
  refused(both(cube, cube, {1, 0, 0}), "the surface touches or crosses itself");
  SurfaceMesh flipped = cube;
  std::swap(flipped.triangles[3][0], flipped.triangles[3][1]);
  refused(flipped, "neighbouring triangles are oriented against each other at 3 edges");
  SurfaceMesh fin = cube;  // a triangle more on an edge
  fin.vertices.push_back({2, 2, 2});
  fin.add_triangle(cube.triangles[0][0], cube.triangles[0][1], static_cast<std::uint32_t>(fin.vertex_count() - 1));
  refused(fin, "the surface is open");
  SurfaceMesh repeated = cube;
  repeated.add_triangle(0, 0, 1);
  refused(repeated, fmt::format("face {} (counted from 0) has a vertex twice", cube.triangle_count()));
  write("mesh.ply", "");
  expect_refused("mesh.ply: the file is empty");
  fs::remove(folder_ / "mesh.ply");
  expect_refused("mesh.ply: no such mesh file");
}

TEST_F(Stress, TrianglesWithoutAreaAreRefusedByNumber) {
  // Edge ab of a tetrahedron is split at m on one side only, a sliver (a, m, b) without area closes the gap.
  write("mesh.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.5 0 0\nf 1 3 2\nf 1 5 4\nf 5 2 4\nf 1 4 3\nf 2 3 4\nf 1 2 5\n");
  write("T.csv", "face,tx,ty,tz\n"), write("P.csv", "x,y,z\n0.1,0.1,0.1\n");
  const Outcome o = sherd(std::string("stress mesh.obj --traction T.csv --points P.csv --out OUT.csv") + kGlass);
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("1 triangles have no area, the first is face 5"), std::string::npos) << o.errors;
}

}  // namespace
}  // namespace sherd::test
