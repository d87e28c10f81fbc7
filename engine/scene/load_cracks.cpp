#include <algorithm>
#include <array>
#include <cmath>

#include "engine/scene/load_body.h"

namespace sherd {
namespace {

constexpr std::array<std::string_view, 3> kGuides{"plane", "polyline", "surface"};

Vec3 require_vector(TableReader& reader, std::string_view key) {
  reader.require(key, fmt::format("type: three numbers [x, y, z]; range {} each", kCoordinate.text()));
  return reader.vector(key, kCoordinate, {});
}

Vec3 require_direction(TableReader& reader, std::string_view key) {
  reader.require(key, "range: a direction [x, y, z], not zero");
  return normalized(read_direction(reader, key, {0, 1, 0}));
}

GuidePlane read_plane(TableReader& reader) {
  const Vec3 point = require_vector(reader, "point");
  return {.point = point, .normal = require_direction(reader, "normal")};
}

std::vector<Vec3> read_points(TableReader& reader) {
  constexpr std::string_view kAllowed = "type: at least two points [[x, y, z], ...], successive ones apart";
  const TomlValue* value = reader.require("points", kAllowed);
  if (!value) return {};
  if (value->kind != TomlValue::Kind::kArray || value->items.size() < 2) {
    reader.problems().refuse(*value, reader.path("points"), kAllowed);
    return {};
  }
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < value->items.size(); ++i) {
    const std::string path = fmt::format("{}[{}]", reader.path("points"), i);
    const auto p = to_vector(value->items[i], path, kCoordinate, reader.problems());
    if (p && !points.empty() && *p == points.back())
      reader.problems().refuse(value->items[i], path, "place: another than the point before");
    if (p) points.push_back(*p);
  }
  return points;
}

GuidePolyline read_polyline(TableReader& reader) {
  GuidePolyline line{.points = read_points(reader), .inward = require_direction(reader, "inward")};
  const TomlValue* inward = reader.find("inward");
  if (inward == nullptr) return line;
  // Below two degrees the swept surface would fold over itself at the least bend of the line.
  constexpr Real kLeastSine = 0.035;
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const Vec3 along = normalized(line.points[i + 1] - line.points[i]);
    if (norm2(along) == 0 || norm(cross(along, line.inward)) > kLeastSine) continue;
    reader.problems().refuse(
        *inward, reader.path("inward"),
        fmt::format("direction: off the line; between points {} and {} it lies along it", i, i + 1));
    break;
  }
  return line;
}

std::size_t read_guide_kind(TableReader& reader, std::size_t count) {
  const std::span<const std::string_view> kinds(kGuides.data(), count);
  reader.require("kind", fmt::format("values: {}", word_list(kinds)));
  return reader.choice("kind", kinds, count);
}

void read_crack(TableReader& reader, const std::filesystem::path& folder, Real duration, SceneBody& body) {
  const std::size_t kind = read_guide_kind(reader, kGuides.size());
  if (kind == kGuides.size()) return;
  SceneCrack crack;
  crack.time = reader.number("time", {0, duration, "s, the scene's duration"}, 0);
  const Range depth{0, kLength.high, "m, 0 for through"};
  if (kind == 0) {
    GuidePlane plane = read_plane(reader);
    plane.depth = reader.number("depth", depth, 0);
    crack.guide = plane;
  } else if (kind == 1) {
    GuidePolyline line = read_polyline(reader);
    line.depth = reader.number("depth", depth, 0);
    crack.guide = line;
  } else if (const TomlValue* mesh = reader.require("mesh", "type: the path of a mesh file, in quotes")) {
    crack.guide = read_mesh_path(reader, *mesh, folder);
  }
  body.cracks.push_back(std::move(crack));
  reader.finish();
}

void read_notch(TableReader& reader, SceneBody& body) {
  const std::size_t kind = read_guide_kind(reader, 2);
  if (kind == 2) return;
  SceneNotch notch;
  const auto required = [&](std::string_view key) {
    reader.require(key, fmt::format("range {}", kLength.text()));
    return reader.number(key, kLength, 1);
  };
  const Real depth = required("depth");
  notch.width = required("width");
  if (kind == 0) {
    GuidePlane plane = read_plane(reader);
    plane.depth = depth;
    notch.guide = plane;
  } else {
    GuidePolyline line = read_polyline(reader);
    line.depth = depth;
    notch.guide = line;
  }
  body.notches.push_back(std::move(notch));
  reader.finish();
}

Box read_region(TableReader& load) {
  Box box{{}, {}};
  if (!load.require("region", "type: a table {low = [x, y, z], high = [x, y, z]}")) return box;
  const TomlValue* value = load.table("region");
  if (!value) return box;
  TableReader reader(*value, load.path("region"), load.problems());
  box = {require_vector(reader, "low"), require_vector(reader, "high")};
  const TomlValue* high = reader.find("high");
  if (high && !(box.low.x < box.high.x && box.low.y < box.high.y && box.low.z < box.high.z))
    load.problems().refuse(*high, reader.path("high"), "range: above low along every axis");
  reader.finish();
  return box;
}

void read_load(TableReader& reader, Scene& scene) {
  SceneLoad load;
  std::vector<std::string_view> names;
  for (const SceneBody& body : scene.bodies)
    if (body.breakable) names.push_back(body.name);
  const std::string allowed = fmt::format("values: breakable bodies: {}", word_list(names));
  const TomlValue* name = reader.require("body", allowed);
  const auto same = [&](const SceneBody& b) { return name && b.breakable && b.name == name->text; };
  const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(), same);
  if (name && found == scene.bodies.end()) reader.problems().refuse(*name, reader.path("body"), allowed);
  load.body = static_cast<std::size_t>(found - scene.bodies.begin());
  load.region = read_region(reader);
  load.facing = normalized(read_direction(reader, "facing", {}));
  load.force = reader.vector("force", {-1e12, 1e12, "N"}, {});
  load.moment = reader.vector("moment", {-1e12, 1e12, "N m"}, {});
  if (norm2(load.force) == 0 && norm2(load.moment) == 0)
    reader.problems().add(reader.value().line, reader.value().column, "load: needs a force or a moment");
  load.from = reader.number("from", {0, scene.duration, "s"}, 0);
  load.until = reader.number("until", {load.from, 3600, "s, after `from`", true}, load.until);
  reader.finish();
  scene.loads.push_back(load);
}

}  // namespace

void read_cracks(TableReader& body, const std::filesystem::path& folder, Real duration, SceneBody& out) {
  for (const TomlValue* value : body.tables("crack")) {
    TableReader reader(*value, body.path("crack"), body.problems());
    if (!out.breakable) body.problems().refuse(*value, body.path("crack"), "use: in a breakable body");
    read_crack(reader, folder, duration, out);
  }
  for (const TomlValue* value : body.tables("notch")) {
    TableReader reader(*value, body.path("notch"), body.problems());
    read_notch(reader, out);
  }
}

void read_loads(TableReader& root, Scene& scene) {
  for (const TomlValue* value : root.tables("load")) {
    TableReader reader(*value, "load", root.problems());
    read_load(reader, scene);
  }
}

}  // namespace sherd
