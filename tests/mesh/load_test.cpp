#include "engine/mesh/load.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/mesh/shapes.h"
#include "engine/mesh/validate.h"
#include "engine/mesh/write.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

class Load : public ::testing::Test {
 protected:
  Load() : folder_(std::filesystem::path(::testing::TempDir()) / ("sherd_load_" + std::string(name()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Load() override { std::filesystem::remove_all(folder_); }
  static const char* name() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }
  std::string path(const std::string& file) const { return (folder_ / file).string(); }
  std::string put(const std::string& file, const std::string& content) const {
    std::ofstream(path(file), std::ios::binary) << content;
    return path(file);
  }
  static std::string content(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  static SurfaceMesh load(const std::string& file, const LoadOptions& options = {}) {
    LoadLog log;
    return load_mesh(file, options, log);
  }
  // The file must be refused with a text that names it and holds `part`.
  static void expect_refused(const std::string& file, const std::string& part, const LoadOptions& options = {}) {
    try {
      load(file, options);
      ADD_FAILURE() << file << " was accepted; expected: " << part;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(file), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  }
  std::filesystem::path folder_;
};

template <class T>
std::string bytes(T value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string stl_of(const SurfaceMesh& mesh) {
  std::string out(80, ' ');
  out += bytes(static_cast<std::uint32_t>(mesh.triangle_count()));
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    out += std::string(12, '\0');
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) out += bytes(static_cast<float>(mesh.corner(t, k)[a]));
    out += std::string(2, '\0');
  }
  return out;
}

std::string chunk(std::uint16_t id, const std::string& body) {
  return bytes(id) + bytes(static_cast<std::uint32_t>(body.size() + 6)) + body;
}

std::string three_ds_of(const SurfaceMesh& mesh) {
  std::string points = bytes(static_cast<std::uint16_t>(mesh.vertex_count()));
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    for (int a = 0; a < 3; ++a) points += bytes(static_cast<float>(mesh.vertices[i][a]));
  std::string faces = bytes(static_cast<std::uint16_t>(mesh.triangle_count()));
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) faces += bytes(static_cast<std::uint16_t>(v));
    faces += bytes(std::uint16_t{0});
  }
  const std::string object = std::string("box\0", 4) + chunk(0x4100, chunk(0x4110, points) + chunk(0x4120, faces));
  return chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, object)));
}

std::string base64(const std::string& in) {
  const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < in.size(); i += 3) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < in.size() ? static_cast<unsigned char>(in[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= in.size() - i ? digits[v >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

// One mesh in a node with the given matrix (column major, as glTF writes it).
std::string gltf_of(const SurfaceMesh& mesh, const std::string& matrix) {
  std::string data;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    for (int a = 0; a < 3; ++a) data += bytes(static_cast<float>(mesh.vertices[i][a]));
  const std::size_t positions = data.size();
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) data += bytes(v);
  const Box box = bounding_box(mesh);
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"matrix":{}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}]}},
{{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],
"buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}]}})",
      matrix, mesh.vertex_count(), box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z,
      3 * mesh.triangle_count(), positions, positions, data.size() - positions, data.size(), base64(data));
}

const char* const kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

// The same box arrives from every format: closed, with its 8 corners and volume. Its coordinates are exact in float.
TEST_F(Load, EveryFormatGivesTheSameSolid) {
  const SurfaceMesh box = make_box({1, 2, 4}, 10);
  write_ply(box, path("float.ply")), write_ply(box, path("double.ply"), PlyPrecision::kDouble);
  write_obj(box, path("box.obj"));
  put("box.stl", stl_of(box)), put("BOX.STL", stl_of(box)), put("box.3ds", three_ds_of(box));
  put("box.gltf", gltf_of(box, "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]"));
  for (const char* file : {"float.ply", "double.ply", "box.obj", "box.stl", "BOX.STL", "box.3ds", "box.gltf"}) {
    const MeshReport r = report_mesh(load(path(file)));
    EXPECT_TRUE(is_valid(r)) << file << "\n" << to_text(r);
    EXPECT_EQ(r.vertices, 8u) << file;
    EXPECT_EQ(r.triangles, 12u) << file;
    EXPECT_NEAR(r.volume, 8.0, 1e-12) << file;
  }
}

// Scale 2 in x, mirrored in z, moved: the volume doubles and stays positive.
TEST_F(Load, NodeTransformsAreAppliedAndMirrorsKeepTheOutside) {
  put("box.gltf", gltf_of(make_box({1, 1, 1}, 10), "[2,0,0,0,0,1,0,0,0,0,-1,0,5,6,7,1]"));
  const SurfaceMesh mesh = load(path("box.gltf"));
  EXPECT_TRUE(is_valid(report_mesh(mesh)));
  EXPECT_NEAR(signed_volume(mesh), 2.0, 1e-12);
  EXPECT_EQ(bounding_box(mesh).low, (Vec3{4, 5.5, 6.5}));
}

TEST_F(Load, ScaleAndUpAxisPlaceTheMesh) {
  const std::string file = put("t.obj", kTetrahedron);
  const Box box = bounding_box(load(file, {.scale = 0.001, .up = UpAxis::kZ}));
  EXPECT_EQ(box.low, (Vec3{0, 0, -0.001}));  // the file's z is up, its y points to -z
  EXPECT_EQ(box.high, (Vec3{0.001, 0.001, 0}));
  EXPECT_NEAR(signed_volume(load(file, {.scale = 2, .up = UpAxis::kZ})), 8.0 / 6, 1e-15);
  expect_refused(file, "scale must be positive", {.scale = 0});
  expect_refused(file, "check the scale", {.scale = 1e12});
}

TEST_F(Load, PolygonsAreCutWithoutOverlap) {
  // An L-shaped prism: concave hexagons, quads with negative indices, a continued line.
  const SurfaceMesh mesh = load(put("l.obj",
                                    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                                    "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
                                    "f 6 5 4 \\\n3 2 1\nf 7/1/1 8//2 9 10 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\n"
                                    "f 4 5 11 10\nf -8 -7 -1 -2 # 5 6 12 11\nf 6 1 7 12\n"));
  const MeshReport r = report_mesh(mesh, {.count_self_intersections = true});
  EXPECT_TRUE(is_valid(r)) << to_text(r);
  EXPECT_EQ(r.triangles, 20u);
  EXPECT_NEAR(r.volume, 3.0, 1e-14);
  EXPECT_NEAR(r.area, 2 * 3 + 8, 1e-14);
}

TEST_F(Load, AsciiAndBigEndianPlyReadLikeLittleEndian) {
  const std::string ascii =
      "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement vertex 4\r\nproperty float nx\r\nproperty double x\r\nproperty "
      "double y\r\n"
      "property double z\r\nelement extra 1\r\nproperty list uchar int junk\r\nelement face 4\r\nproperty list uchar "
      "uint "
      "vertex_index\r\nproperty uchar red\r\nend_header\r\n9 0 0 0\r\n9 1 0 0\r\n9 0 1 0\r\n9 0 0 1\r\n2 5 5\r\n3 0 2 "
      "1 7\r\n3 0 1 3 7\r\n"
      "3 1 2 3 7\r\n3 0 3 2 7";
  EXPECT_NEAR(signed_volume(load(put("a.ply", ascii))), 1.0 / 6, 1e-15);
  std::string big =
      "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar ushort vertex_indices\nend_header\n";
  const std::string one("\x3F\x80\0\0", 4), zero(4, '\0');
  big += zero + zero + zero + one + zero + zero + zero + one + zero + zero + zero + one;
  for (const std::string& f : {std::string("\3\0\0\0\2\0\1", 7), std::string("\3\0\0\0\1\0\3", 7),
                               std::string("\3\0\1\0\2\0\3", 7), std::string("\3\0\0\0\3\0\2", 7)})
    big += f;
  EXPECT_NEAR(signed_volume(load(put("b.ply", big))), 1.0 / 6, 1e-15);
}

TEST_F(Load, NearbyBorderVerticesAreJoinedOnlyWhereThatClosesBorders) {
  // Every triangle with its own corners, each off by up to 1e-9 of the size.
  const SurfaceMesh sphere = make_sphere(1, 0.5);
  std::string text, faces;
  for (std::size_t t = 0; t < sphere.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = sphere.corner(t, k) + 1e-9 * Vec3{static_cast<Real>(t % 3), static_cast<Real>(t % 2), 0};
      text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
    }
  for (std::size_t t = 0; t < sphere.triangle_count(); ++t)
    text += fmt::format("f {} {} {}\n", 3 * t + 1, 3 * t + 2, 3 * t + 3);
  LoadLog log;
  const SurfaceMesh mesh = load_mesh(put("soup.obj", text), {}, log);
  EXPECT_EQ(mesh.vertex_count(), sphere.vertex_count());
  EXPECT_TRUE(is_valid(report_mesh(mesh)));
  EXPECT_FALSE(log.messages.empty());

  // Two closed tetrahedra at one place stay apart: joined they would be copies of each other.
  std::string twice = kTetrahedron;
  twice += "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n";
  EXPECT_EQ(load(put("twice.obj", twice)).vertex_count(), 8u);
}

TEST_F(Load, UselessTrianglesAreDroppedWithAMessage) {
  LoadLog log;
  const SurfaceMesh mesh = load_mesh(put("t.obj", std::string(kTetrahedron) + "f 1 1 2\nf 2 1 3\n"), {}, log);
  EXPECT_EQ(mesh.triangle_count(), 4u);
  ASSERT_EQ(log.messages.size(), 2u);
  EXPECT_EQ(log.messages[0], "dropped 1 triangles with a repeated vertex");
  EXPECT_EQ(log.messages[1], "dropped 1 copies of triangles");
  EXPECT_EQ(mesh.faces.source, (std::vector<std::int32_t>{0, 1, 2, 3}));
}

TEST_F(Load, FilesThatAreNoMeshAreRefused) {
  expect_refused(path("nothing.obj"), "no such mesh file");
  std::filesystem::create_directories(path("folder.obj"));
  expect_refused(path("folder.obj"), "is a folder");
  for (const char* file : {"e.obj", "e.ply", "e.stl", "e.gltf", "e.glb", "e.3ds"})
    expect_refused(put(file, ""), "0 bytes");
  expect_refused(put("mesh.xyz", "1 2 3"), "unknown ending '.xyz'");
  for (const char* file : {"g.ply", "g.stl", "g.gltf", "g.glb", "g.3ds"})
    expect_refused(put(file, "this is no mesh at all, only text\n"), path(file));
  expect_refused(put("g.obj", "this is no mesh at all, only text\n"), "no triangles");
  expect_refused(put("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), "no triangles");
  expect_refused(put("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 2\n"), "no triangle");
}

TEST_F(Load, BadNumbersAreRefusedWithTheirPlace) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_refused(put("a.obj", "v 0 0 0\nv nan 0 0\n"), ":2: vertex 2 has a coordinate that is not finite");
  expect_refused(put("b.obj", "v 0 0 0\nv 1 inf 0\n"), ":2: vertex 2");
  expect_refused(put("c.obj", "v 0 0\n"), ":1: vertex 1");
  expect_refused(put("d.obj", "v 0 0 zero\n"), "'zero' is no coordinate");
  expect_refused(put("e.obj", points + "f 1 2 4\n"), ":4: a face uses vertex 4 of 3");
  expect_refused(put("f.obj", points + "f 1 2 0\n"), ":4: '0' is no vertex");
  expect_refused(put("g.obj", points + "f 1 2 -4\n"), ":4: a face uses vertex -4 of 3");
  expect_refused(put("h.obj", points + "f 1 2\n"), ":4: a face with 2 vertices");
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  expect_refused(put("a.ply", head + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"), "vertex 1 (counted from 0)");
  expect_refused(put("b.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "face 0 (counted from 0) uses vertex 3 of 3");
  expect_refused(put("c.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), "face 0 (counted from 0) uses vertex -1 of 3");
  SurfaceMesh box = make_box({1, 1, 1}, 1);
  box.vertices.x[3] = std::numeric_limits<Real>::quiet_NaN();
  expect_refused(put("a.stl", stl_of(box)), "not finite");
  expect_refused(put("a.3ds", three_ds_of(box)), "not finite");
}

TEST_F(Load, TruncatedFilesAreRefused) {
  const SurfaceMesh box = make_box({1, 1, 1}, 0.5);
  write_ply(box, path("whole.ply"));
  const std::string ply = content(path("whole.ply")), stl = stl_of(box);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{100}, ply.size() / 2})
    expect_refused(put("cut.ply", ply.substr(0, ply.size() - cut)), "truncated");
  expect_refused(put("header.ply", ply.substr(0, 40)), "no end_header");
  for (const std::size_t cut : {std::size_t{1}, std::size_t{1000}})
    expect_refused(put("cut.stl", stl.substr(0, stl.size() - cut)), "truncated");
  expect_refused(
      put("ascii.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"),
      "truncated");
  const std::string gltf = gltf_of(box, "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]");
  expect_refused(put("cut.gltf", gltf.substr(0, gltf.size() / 2)), "its JSON text is damaged or truncated");
  std::string wild = gltf;
  wild.replace(wild.find("\"count\":26"), 10, "\"count\":99999999");
  expect_refused(put("wild.gltf", wild), "more than its buffer view holds");
  std::string glb("glTF\2\0\0\0", 8);
  glb += bytes(std::uint32_t{1000}) + bytes(std::uint32_t{4}) + "JSON{}  ";
  expect_refused(put("cut.glb", glb), "truncated: 24 of 1000 bytes");
  expect_refused(put("apart.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":8,"uri":"gone.bin"}]})"),
                 "gone.bin");
  // A count no file of this size can hold must not be believed (nor allocated).
  expect_refused(
      put("huge.ply",
          "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\nproperty float x\n"
          "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"),
      "truncated");
}

}  // namespace
}  // namespace sherd
