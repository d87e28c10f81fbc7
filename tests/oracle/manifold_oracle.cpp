#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/oracle/oracle.h"

namespace sherd {
namespace {

const char* const kLibrary = SHERD_SOURCE "/build-oracles/manifold-3d-3.5.4/package/manifold.js";

void put(std::ofstream& file, std::uint32_t n) {
  file.write(reinterpret_cast<const char*>(&n), sizeof n);
}

void put(std::ofstream& file, const SurfaceMesh* mesh) {
  put(file, mesh ? static_cast<std::uint32_t>(mesh->vertex_count()) : 0);
  put(file, mesh ? static_cast<std::uint32_t>(mesh->triangle_count()) : 0);
  if (!mesh) return;
  for (std::size_t i = 0; i < mesh->vertex_count(); ++i)
    for (int k = 0; k < 3; ++k) {
      const auto x = static_cast<float>(mesh->vertices[i][k]);
      file.write(reinterpret_cast<const char*>(&x), sizeof x);
    }
  for (const Triangle& t : mesh->triangles)
    for (const std::uint32_t v : t) put(file, v);
}

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return text;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  return pclose(pipe) == 0 ? text : "";
}

}  // namespace

bool manifold_available(std::string& why_not) {
  if (!std::filesystem::exists(kLibrary))
    why_not = std::string("no ") + kLibrary + "; tools/setup --oracles installs it";
  else if (output_of("node --version 2>/dev/null").empty())
    why_not = "no node; tools/setup --oracles installs it";
  return why_not.empty();
}

std::vector<OracleAnswer> manifold_difference(const std::vector<MeshPair>& pairs) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sherd_oracle_" + std::to_string(getpid()) + ".bin");
  {
    std::ofstream file(path, std::ios::binary);
    put(file, static_cast<std::uint32_t>(pairs.size()));
    for (const MeshPair& p : pairs) put(file, p.body), put(file, p.slab);
  }
  const std::string text = output_of(std::string("node '" SHERD_SOURCE "/tests/oracle/manifold.mjs' '") + kLibrary +
                                     "' '" + path.string() + "'");
  std::filesystem::remove(path);
  std::vector<OracleAnswer> answers(pairs.size());
  const auto json = nlohmann::json::parse(text, nullptr, false);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!json.is_array() || json.size() != pairs.size()) {
      answers[i].reason = "node gave no answer";
      continue;
    }
    answers[i].ok = json[i]["ok"], answers[i].closed = json[i]["closed"], answers[i].reason = json[i]["reason"];
    answers[i].volumes = json[i]["volumes"].get<std::vector<double>>();
  }
  return answers;
}

}  // namespace sherd
