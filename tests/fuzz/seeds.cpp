// Small meshes in every format that load_mesh() reads, for the fuzzers to start from: fuzz_seeds FOLDER.
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "engine/mesh/shapes.h"
#include "engine/mesh/write.h"

namespace {

namespace fs = std::filesystem;

std::string in(const fs::path& folder, const char* format, const char* name) {
  fs::create_directories(folder / format);
  return (folder / format / (std::string(name) + "." + format)).string();
}

void write_text(const std::string& file, const char* text) {
  std::ofstream(file, std::ios::binary) << text;
}

bool convert(const std::string& from, const char* id, const std::string& to) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(from, 0);
  return scene != nullptr && Assimp::Exporter().Export(scene, id, to) == aiReturn_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
    return 2;
  }
  using namespace sherd;
  const fs::path folder = argv[1];
  const SurfaceMesh box = make_box({1, 1, 1}, 1), ball = make_sphere(1, 1.2);
  write_ply(box, in(folder, "ply", "box"));
  write_ply(ball, in(folder, "ply", "ball"), PlyPrecision::kDouble);
  write_text(in(folder, "ply", "text"),
             "ply\nformat ascii 1.0\ncomment four faces\nelement vertex 4\nproperty float x\nproperty float y\n"
             "property float z\nproperty float u\nelement face 4\nproperty list uchar int vertex_indices\n"
             "property list uchar float texcoord\nend_header\n0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n"
             "3 0 2 1 0\n3 0 1 3 0\n3 0 3 2 0\n3 1 2 3 6 0 0 1 0 0 1\n");
  write_obj(box, in(folder, "obj", "box"));
  write_text(in(folder, "obj", "relative"),
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1 1 0.5 0.5\nvt 0 0\nvn 0 0 1\ng a\nf -4/1/1 -2/1/1 -3/1/1\n"
             "f 1//1 2//1 4//1\nf 1 4 3\nf 2 3 \\\n 4\n");
  write_text(in(folder, "off", "tetrahedron"),
             "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3 255 0 0\n3 0 3 2\n3 1 2 3\n");
  write_text(in(folder, "off", "quads"),
             "COFF\n# a box\n8 6 12\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n1 1 0 1 1 1 1\n0 1 0 1 1 1 1\n0 0 1 1 1 1 1\n"
             "1 0 1 1 1 1 1\n1 1 1 1 1 1 1\n0 1 1 1 1 1 1\n4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n"
             "4 3 0 4 7\n");
  const std::string from = in(folder, "obj", "box");
  const bool all = convert(from, "stl", in(folder, "stl", "text")) &&
                   convert(from, "stlb", in(folder, "stl", "binary")) &&
                   convert(from, "gltf2", in(folder, "gltf", "box")) &&
                   convert(from, "glb2", in(folder, "glb", "box")) && convert(from, "3ds", in(folder, "3ds", "box"));
  if (!all) std::fprintf(stderr, "fuzz_seeds: assimp cannot write one of the formats\n");
  return all ? 0 : 1;
}
