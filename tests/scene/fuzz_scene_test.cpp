// Whatever a scene file says, it is read or refused with a message.
#include "kernels/core/random.h"
#include "tests/scene/scene_file.h"

namespace sherd {
namespace {

using FuzzScene = SceneFile;

std::string everything() {
  std::ifstream file(SHERD_SOURCE "/tests/scene/everything.toml");
  return {std::istreambuf_iterator<char>(file), {}};
}

// One edit: a line dropped, doubled or moved, or a piece of a line replaced by a piece that stands elsewhere.
std::string edited(std::string text, Random& random) {
  static const std::string kPieces[] = {"0",   "-1",   "1e400", "nan",   "inf",
                                        "[]",  "{}",   "\"\"",  "true",  "[0, 0, 0]",
                                        "1.5", "-1e9", "\"x\"", "[[0]]", "{kind = \"share\", factor = 0.5}",
                                        "=",   "[",    "}"};
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random.next() % n); };
  const std::size_t at = pick(text.size()), begin = text.rfind('\n', at) + 1,  // npos + 1 is the first line
      end = std::min(text.find('\n', at), text.size() - 1) + 1;
  const std::string line = text.substr(begin, end - begin);
  switch (pick(4)) {
    case 0:
      return text.erase(begin, end - begin);
    case 1:
      return text.insert(begin, line);
    case 2:
      return text.erase(begin, end - begin) + line;
    default:
      const std::size_t equals = line.find('=');
      if (equals == std::string::npos) return text.erase(at, 1);
      return text.replace(begin + equals + 1, line.size() - equals - 2, " " + kPieces[pick(std::size(kPieces))]);
  }
}

TEST_F(FuzzScene, EditsAreReadOrRefused) {
  const std::string whole = everything();
  ASSERT_EQ(problem(whole), "");
  Random random(11);
  int read = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    for (std::uint64_t edits = 1 + random.next() % 3; edits > 0; --edits) text = edited(std::move(text), random);
    const std::filesystem::path file = write("scene.toml", text);
    try {
      const Scene scene = load_scene(file);
      ++read;
      const SurfaceMesh none;
      for (const SceneBody& body : scene.bodies) {
        const MaterialFields fields = scene_fields(body, none);
        EXPECT_GT(fields.propagation_strength->lower(), 0) << text;
        EXPECT_LE(fields.propagation_strength->at({}), fields.strength->at({})) << text;
      }
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("scene.toml:"), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace sherd
