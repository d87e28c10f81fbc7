// What assimp takes without complaint, or at its word, is looked at first: sizes and counts that do not fit the file.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/mesh/load_raw.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

using nlohmann::json;

std::uint32_t little_endian(const std::string& content, std::size_t at) {
  const auto byte = [&](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(content[at + i])}; };
  return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

class GltfCheck {
 public:
  GltfCheck(const std::string& path, const std::string& text, std::size_t binary_size)
      : path_(path), binary_size_(binary_size) {
    root_ = json::parse(text, nullptr, false);
  }

  void run() const {
    if (root_.is_discarded() || !root_.is_object()) fail("its JSON text is damaged or truncated");
    for (std::size_t i = 0; i < list("buffers").size(); ++i) check_buffer(list("buffers")[i], i);
    for (std::size_t i = 0; i < list("bufferViews").size(); ++i) {
      const json& view = list("bufferViews")[i];
      const std::size_t end = number(view, "byteOffset", 0) + number(view, "byteLength", kNeeded);
      if (end > number(entry("buffers", number(view, "buffer", kNeeded)), "byteLength", kNeeded))
        fail(fmt::format("buffer view {} ends beyond its buffer", i));
    }
    for (std::size_t i = 0; i < list("accessors").size(); ++i) {
      const json& accessor = list("accessors")[i];
      const std::size_t count = number(accessor, "count", kNeeded);
      if (!accessor.contains("bufferView")) continue;
      const json& view = entry("bufferViews", number(accessor, "bufferView", kNeeded));
      if (number(accessor, "byteOffset", 0) + count > number(view, "byteLength", kNeeded))
        fail(fmt::format("accessor {} has {} entries, more than its buffer view holds", i, count));
    }
  }

 private:
  static constexpr std::size_t kNeeded = ~std::size_t{0};

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: not a usable glTF file: {}; export the file again", path_, what));
  }
  const json& list(const char* name) const {
    static const json none = json::array();
    const auto it = root_.find(name);
    if (it == root_.end()) return none;
    if (!it->is_array()) fail(fmt::format("'{}' is no list", name));
    return *it;
  }
  const json& entry(const char* name, std::size_t i) const {
    if (i >= list(name).size()) fail(fmt::format("it uses entry {} of {} in '{}'", i, list(name).size(), name));
    return list(name)[i];
  }
  std::size_t number(const json& object, const char* name, std::size_t otherwise) const {
    const auto it = object.is_object() ? object.find(name) : object.end();
    if (object.is_object() && it == object.end() && otherwise != kNeeded) return otherwise;
    if (!object.is_object() || it == object.end() || !it->is_number_unsigned())
      fail(fmt::format("'{}' is missing or no count", name));
    const auto value = it->get<std::size_t>();
    if (value > 0xFFFFFFFFu) fail(fmt::format("'{}' is {}", name, value));
    return value;
  }
  void check_buffer(const json& buffer, std::size_t i) const {
    const std::size_t length = number(buffer, "byteLength", kNeeded);
    std::size_t held = binary_size_;
    if (buffer.contains("uri")) {
      if (!buffer["uri"].is_string()) fail(fmt::format("the address of buffer {} is no text", i));
      const auto uri = buffer["uri"].get<std::string>();
      if (uri.rfind("data:", 0) == 0) {
        held = uri.size();  // more than the decoded bytes: enough to keep wild lengths out
      } else if (uri.find('%') == std::string::npos) {
        std::error_code error;
        const auto file = std::filesystem::path(path_).parent_path() / uri;
        held = static_cast<std::size_t>(std::filesystem::file_size(file, error));
        if (error)
          fail(fmt::format("its buffer file '{}' cannot be read; put it beside the .gltf file", file.string()));
      } else {
        return;  // an escaped name: left to assimp
      }
    }
    if (length > held) fail(fmt::format("it is truncated: buffer {} needs {} bytes, there are {}", i, length, held));
  }

  const std::string& path_;
  std::size_t binary_size_;
  json root_;
};

}  // namespace

// Binary STL states its count; assimp reads what is there of a shorter or an ascii file without complaint.
void check_stl(const std::string& path, const std::string& content) {
  const bool solid = content.compare(0, 5, "solid") == 0;
  std::size_t promised = 0;
  if (content.size() >= 84) {
    promised = little_endian(content, 80);
  }
  if (content.size() >= 84 && content.size() == 84 + 50 * promised) return;
  if (solid && content.find("facet") != std::string::npos) {
    if (content.find("endsolid") == std::string::npos)
      throw InputError(fmt::format("{}: the ascii STL file is truncated (no 'endsolid'); export it again", path));
    return;
  }
  if (content.size() < 84 + 50 * promised || promised == 0)
    throw InputError(
        fmt::format("{}: the STL file is truncated: {} triangles need {} bytes, it has {}; export it again", path,
                    promised, 84 + 50 * promised, content.size()));
}

void check_gltf(const std::string& path, const std::string& content) {
  GltfCheck(path, content, 0).run();
}

void check_glb(const std::string& path, const std::string& content) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}: not a usable GLB file: {}; export the file again", path, what));
  };
  if (content.size() < 20 || content.compare(0, 4, "glTF") != 0) fail("it does not start with a GLB header");
  const std::size_t total = little_endian(content, 8), text = little_endian(content, 12);
  if (total > content.size()) fail(fmt::format("it is truncated: {} of {} bytes are there", content.size(), total));
  if (content.compare(16, 4, "JSON") != 0 || text > content.size() - 20) fail("its JSON part is damaged");
  std::size_t binary = 0;
  if (content.size() - 20 - text >= 8) {
    binary = little_endian(content, 20 + text);
    if (binary > content.size() - 28 - text) fail("its binary part is truncated");
  }
  GltfCheck(path, content.substr(20, text), binary).run();
}

}  // namespace sherd
