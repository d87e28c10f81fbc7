#include "tools/campaign/random_scene.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kernels/core/random.h"
#include "kernels/core/vec3.h"

namespace sherd::campaign {
namespace {

class SceneWriter {
 public:
  SceneWriter(std::uint64_t seed, double duration) : random_(seed), duration_(duration) {}

  std::string text() {
    size_ = decades(-3, 2);
    const double step = decades(-4, -2);
    line("time_step = {:.4g}", step);
    line("duration = {:.4g}", std::max(duration_, step));
    line("frame_rate = {:.4g}", std::min(1 / step, 10.0));
    if (chance(0.2)) line("gravity = {}", vector(direction() * decades(-1, 2)));
    const int bodies = 1 + pick(4);
    for (int i = 0; i < bodies; ++i) body(i);
    line("[ground]\nenabled = {}\nrestitution = {:.3f}\nfriction = {:.3f}", chance(0.8), random_.uniform(0, 1),
         random_.uniform(0, 1.5));
    if (chance(0.5)) line("[contact]\nmin_duration = {:.4g}", step * decades(-2, 0));
    // Few pieces, so that a scene of many cracks ends within its time.
    line(
        "[fracture]\nmax_fragments = 24\nmax_cracks = 3\nrounds = {}\nnet_section = {}\ninterior_seeds = {}\ndust = "
        "\"{}\"",
        1 + pick(2), chance(0.7), chance(0.2), chance(0.5) ? "keep" : "drop");
    return std::move(text_);
  }

 private:
  template <class... T>
  void line(fmt::format_string<T...> format, T&&... values) {
    text_ += fmt::format(format, std::forward<T>(values)...) + "\n";
  }
  double decades(double low, double high) { return std::pow(10, random_.uniform(low, high)); }
  bool chance(double share) { return random_.uniform() < share; }
  int pick(int n) { return static_cast<int>(random_.next() % static_cast<std::uint64_t>(n)); }
  static std::string vector(const Vec3& v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); }
  Vec3 direction() {
    Vec3 v;
    do {
      for (int k = 0; k < 3; ++k) v[k] = random_.uniform(-1, 1);
    } while (!(norm2(v) > 0.01));
    return normalized(v);
  }

  // The shape's text, its largest extent, and an edge length that gives a few hundred triangles.
  struct Shape {
    std::string text;
    double extent = 0, edge = 0;
  };
  Shape shape() {
    const double a = size_ * random_.uniform(0.3, 1), b = a * random_.uniform(0.3, 1),
                 c = a * random_.uniform(0.1, 0.5);
    switch (pick(8)) {
      case 0:
        return {fmt::format("{{kind = \"box\", size = [{:.4g}, {:.4g}, {:.4g}]}}", a, b, c), a,
                0.4 * std::cbrt(a * b * c)};
      case 1:
        return {fmt::format("{{kind = \"sphere\", radius = {:.4g}}}", 0.5 * a), a, 0.16 * a};
      case 2:
        return {fmt::format("{{kind = \"hollow_sphere\", radius = {:.4g}, inner_radius = {:.4g}}}", 0.5 * a,
                            0.5 * a * random_.uniform(0.3, 0.8)),
                a, 0.18 * a};
      case 3:
        return {fmt::format("{{kind = \"plate\", width = {:.4g}, depth = {:.4g}, thickness = {:.4g}}}", a, b, 0.2 * c),
                a, 0.15 * a};
      case 4:
        return {fmt::format("{{kind = \"bar\", length = {:.4g}, height = {:.4g}, width = {:.4g}}}", a, c, c), a,
                0.5 * c};
      case 5:
        return {fmt::format("{{kind = \"cylinder\", radius = {:.4g}, height = {:.4g}}}", 0.3 * b, a), a, 0.3 * b};
      case 6:
        return {fmt::format("{{kind = \"torus\", radius = {:.4g}, tube_radius = {:.4g}}}", 0.35 * a, 0.35 * c), a,
                0.3 * c};
      default:
        return {fmt::format("{{kind = \"goblet\", height = {:.4g}, bowl_radius = {:.4g}, wall = {:.4g}}}", a, 0.25 * a,
                            0.02 * a),
                a, 0.08 * a};
    }
  }

  void body(int number) {
    const Shape s = shape();
    line("[[body]]\nname = \"body{}\"\nshape = {}\nedge_length = {:.4g}", number, s.text, s.edge);
    // Above one another with gaps, or touching, so that none starts inside another.
    const bool touching = chance(0.3);
    top_ += s.extent * (touching ? 1.0 : random_.uniform(1, 2));
    line("position = {}", vector({size_ * random_.uniform(-0.3, 0.3), top_, size_ * random_.uniform(-0.3, 0.3)}));
    top_ += s.extent;
    line("rotation = {{axis = {}, angle = {:.4g}}}", vector(direction()), random_.uniform(0, 360));
    const bool fixed = chance(0.1);
    if (fixed) line("fixed = true");
    if (!fixed && chance(0.8)) line("velocity = {}", vector(direction() * decades(-2, 2)));
    if (!fixed && chance(0.5)) line("angular_velocity = {}", vector(direction() * decades(-1, 2)));
    const bool breakable = !fixed && chance(0.9);
    if (!fixed && !breakable) line("breakable = false");
    material();
    if (breakable && chance(0.1))
      line("[[body.crack]]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = {}\ntime = 0.01", vector(direction()));
    if (breakable && chance(0.1))
      line(
          "[[load]]\nbody = \"body{}\"\nregion = {{low = [{}, {}, {}], high = [{}, {}, {}]}}\nforce = {}\nfrom = "
          "0\nuntil = 0.01",
          number, -2 * size_, -2 * size_, -2 * size_, 2 * size_, 2 * size_, 2 * size_,
          vector(direction() * decades(0, 6) * size_ * size_));
  }

  void material() {
    const double young = decades(6, 12);
    line("[body.material]\npreset = \"{}\"\ndensity = {:.4g}\nyoung = {:.4g}\npoisson = {:.3f}",
         std::array{"glass", "ceramic", "plaster"}[static_cast<std::size_t>(pick(3))], decades(2, 4), young,
         random_.uniform(0, 0.45));
    const double strength = std::max(100.0, young * decades(-6, -2));
    line("strength = {:.4g}\npropagation_strength = {:.4g}\nrestitution = {:.3f}\nfriction = {:.3f}", strength,
         std::max(100.0, strength * decades(-2, 0)), random_.uniform(0, 1), random_.uniform(0, 1.5));
  }

  Random random_;
  double duration_, size_ = 1, top_ = 0;
  std::string text_;
};

// Paths of numbers that are not numbers: nlohmann writes NaN and infinities as null.
void find_null(const nlohmann::json& j, const std::string& path, std::vector<std::string>& out) {
  static constexpr std::array kMayBeNull{"thinnest",           "worst",           "worst_edge",
                                         "worst_thickness",    "governing",       "edge_for_5_percent",
                                         "edge_for_1_percent", "limit_1_percent", "share_above_1_percent"};
  for (const auto& [key, value] : j.items()) {
    const bool allowed = std::any_of(kMayBeNull.begin(), kMayBeNull.end(), [&](const char* k) { return key == k; }) ||
                         key.starts_with("triangles_for") || key.starts_with("graded_for");
    if (value.is_null() && !allowed && out.size() < 5) out.push_back(path + "/" + key + " is not a finite number");
    if (value.is_structured()) find_null(value, path + "/" + key, out);
  }
}

}  // namespace

std::string random_scene(std::uint64_t seed, double duration) {
  return SceneWriter(seed, duration).text();
}

std::vector<std::string> broken_laws(const nlohmann::json& stats) {
  std::vector<std::string> broken;
  find_null(stats, "", broken);
  for (const auto& c : stats["certificates"])
    if (c.contains("first_defect") && !c["first_defect"].get<std::string>().empty())
      broken.push_back(fmt::format("{} v{}: {}", c["body"].get<std::string>(), c["mesh_version"].dump(),
                                   c["first_defect"].get<std::string>()));
  for (const auto& f : stats["frames"]) {
    if (f["valid"] != f["bodies"])
      broken.push_back(fmt::format("frame {}: not every mesh is certified", f["frame"].dump()));
    // Sums of some hundred meshes' volumes in double precision, and refits' own promise.
    if (f["volume"]["error"] > 1e-9)
      broken.push_back(fmt::format("frame {}: volume off by {}", f["frame"].dump(), f["volume"]["error"].dump()));
  }
  for (const auto& e : stats["events"]) {
    if (!e.contains("conservation")) continue;
    for (const auto& [key, value] : e["conservation"].items())
      if (!(value < 1e-9))
        broken.push_back(fmt::format("step {}: {} of {} changed by {}", e["step"].dump(), key,
                                     e["body"].get<std::string>(), value.dump()));
  }
  for (const auto& s : stats["steps"])
    if (s.contains("energy") && !s["energy"]["holds"].get<bool>())
      broken.push_back(fmt::format("step {}: energy grew by {} J", s["step"].dump(), s["energy"]["growth"].dump()));
  return broken;
}

}  // namespace sherd::campaign
