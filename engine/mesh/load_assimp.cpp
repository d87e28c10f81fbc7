// STL, glTF and 3DS through assimp; no other file includes it. It reads in a process of its own, for files can be
// damaged so that it crashes (found by tools/fuzz; assimp 5.2).
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>

#include "engine/mesh/load_raw.h"
#include "kernels/core/archive.h"
#include "kernels/core/child.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

struct Collector {
  const aiScene& scene;
  const std::string& path;
  SurfaceMesh mesh;
  std::size_t other_faces = 0;
  std::vector<float> uv;  // of each corner, (0, 0) for parts without texture coordinates
  bool textured = false;

  void add(const aiNode& node, const aiMatrix4x4& parent, int depth) {
    if (depth > 1000)
      throw InputError(fmt::format("{}: its nodes are nested deeper than 1000; flatten the scene", path));
    const aiMatrix4x4 m = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene.mMeshes[node.mMeshes[i]], m, node.mName.C_Str());
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], m, depth + 1);
  }

  void add(const aiMesh& part, const aiMatrix4x4& m, const char* node) {
    const auto offset = static_cast<std::uint32_t>(mesh.vertex_count());
    const Vec3 x{m.a1, m.b1, m.c1}, y{m.a2, m.b2, m.c2}, z{m.a3, m.b3, m.c3}, o{m.a4, m.b4, m.c4};
    const bool mirrored = dot(x, cross(y, z)) < 0;
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      const Vec3 p = static_cast<Real>(v.x) * x + static_cast<Real>(v.y) * y + static_cast<Real>(v.z) * z + o;
      if (!is_finite(p))
        throw InputError(
            fmt::format("{}: vertex {} of mesh '{}' in node '{}' has a coordinate that is not finite; export the "
                        "file again",
                        path, i, part.mName.C_Str(), node));
      mesh.vertices.push_back(p);
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& f = part.mFaces[i];
      if (f.mNumIndices != 3) {
        ++other_faces;
        continue;
      }
      const unsigned a = f.mIndices[0], b = f.mIndices[mirrored ? 2 : 1], c = f.mIndices[mirrored ? 1 : 2];
      if (a >= part.mNumVertices || b >= part.mNumVertices || c >= part.mNumVertices)
        throw InputError(fmt::format("{}: face {} of mesh '{}' has a vertex index out of range; export the file again",
                                     path, i, part.mName.C_Str()));
      mesh.add_triangle(offset + a, offset + b, offset + c);
      for (const unsigned v : {a, b, c}) add_texture(part, v);
    }
  }

  void add_texture(const aiMesh& part, unsigned v) {
    const bool has = part.HasTextureCoords(0);
    const aiVector3D at = has ? part.mTextureCoords[0][v] : aiVector3D();
    const bool finite = std::isfinite(at.x) && std::isfinite(at.y);
    uv.push_back(finite ? at.x : 0), uv.push_back(finite ? at.y : 0);
    textured = textured || has;
  }
};

// assimp quotes the rest of the file in some messages.
std::string one_line(std::string text) {
  if (text.size() > 160) text = text.substr(0, 160) + "...";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = ' ';
  return text;
}

SurfaceMesh read_here(const std::string& path, std::vector<std::string>& messages) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(
        fmt::format("{}: cannot be read ({}); export the file again", path, one_line(importer.GetErrorString())));
  if ((scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0)
    throw InputError(fmt::format("{}: the file is incomplete; export it again", path));
  Collector collector{*scene, path, {}, 0, {}, false};
  collector.add(*scene->mRootNode, aiMatrix4x4(), 0);
  if (collector.other_faces > 0) messages.push_back(fmt::format("left out {} points and lines", collector.other_faces));
  if (collector.textured) collector.mesh.channels = {{"uv", 2, std::move(collector.uv)}};
  return std::move(collector.mesh);
}

struct Reading {
  SurfaceMesh mesh;
  std::vector<std::string> messages;
  std::string error;  // of an InputError
};

// Processor time, s, beyond which a file is taken to be damaged; assimp reads many times as fast.
unsigned patience(const std::string& path) {
  std::error_code none;
  const auto bytes = std::filesystem::file_size(path, none);
  return 10 + static_cast<unsigned>(std::min<std::uintmax_t>(none ? 0 : bytes / 100'000, 3600));
}

}  // namespace

SurfaceMesh read_assimp(const std::string& path, std::vector<std::string>& messages) {
  const ChildResult child = run_in_child(
      [&] {
        Reading r;
        try {
          r.mesh = read_here(path, r.messages);
        } catch (const InputError& e) {
          r.error = e.what();
        }
        Archive a;
        archive(a, r);
        return a.take();
      },
      patience(path));
  if (!child.died.empty())
    throw InputError(
        fmt::format("{}: the file is damaged: reading it ended in {}; export the file again", path, child.died));
  Reading r;
  Archive a(child.bytes);
  archive(a, r);
  if (!r.error.empty()) throw InputError(r.error);
  messages.insert(messages.end(), r.messages.begin(), r.messages.end());
  return std::move(r.mesh);
}

}  // namespace sherd
