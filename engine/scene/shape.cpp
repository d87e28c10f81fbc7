#include <array>
#include <cmath>
#include <numbers>

#include "engine/mesh/shapes.h"
#include "engine/scene/load_body.h"
#include "kernels/core/overload.h"

namespace sherd {
namespace {

constexpr std::array<std::string_view, 13> kKinds{"box",      "sphere",       "hollow_sphere", "plate", "bar",
                                                  "cylinder", "dinner_plate", "goblet",        "torus", "tumbler",
                                                  "vase",     "figurine",     "twisted_column"};

// A required length of a shape; 1 m after a problem, so that limits that depend on it make sense.
Real read_length(TableReader& reader, std::string_view key, Real high = kLength.high) {
  const Range range{kLength.low, high, "m"};
  if (!reader.require(key, fmt::format("range {}", range.text()))) return 1;
  return reader.number(key, range, 1);
}

ShapeSpec read_table_piece(std::string_view kind, TableReader& r) {
  const Real height = read_length(r, "height");
  if (kind == "figurine") return FigurineShape{height};
  if (kind == "tumbler") {
    const Real radius = read_length(r, "radius");
    return TumblerShape{height, radius, read_length(r, "wall", 0.2 * std::min(radius, height))};
  }
  if (kind == "vase") {
    const Real radius = read_length(r, "radius", height);
    return VaseShape{height, radius, read_length(r, "wall", 0.15 * radius)};
  }
  const Real width = read_length(r, "width"), most = 360 * height / width;
  return TwistedColumnShape{width, height, r.number("turn", {-most, most, "degrees"}, 0) * std::numbers::pi / 180};
}

ShapeSpec read_kind(std::string_view kind, TableReader& r) {
  // Wall thicknesses are bounded as the generators need them (engine/mesh/shapes.h); 0.999 keeps a cavity inside.
  if (kind == "box") {
    if (!r.require("size", fmt::format("type: three numbers [x, y, z]; range {} each", kLength.text())))
      return BoxShape{{1, 1, 1}};
    return BoxShape{r.vector("size", kLength, {1, 1, 1})};
  }
  if (kind == "sphere") return SphereShape{read_length(r, "radius")};
  if (kind == "hollow_sphere") {
    const Real radius = read_length(r, "radius");
    return HollowSphereShape{radius, read_length(r, "inner_radius", 0.999 * radius)};
  }
  if (kind == "plate") {
    const Real width = read_length(r, "width"), depth = read_length(r, "depth");
    return PlateShape{width, depth, read_length(r, "thickness")};
  }
  if (kind == "bar") {
    const Real length = read_length(r, "length"), height = read_length(r, "height");
    return BarShape{length, height, read_length(r, "width")};
  }
  if (kind == "cylinder") {
    const Real radius = read_length(r, "radius");
    return CylinderShape{radius, read_length(r, "height")};
  }
  if (kind == "dinner_plate") {
    const Real radius = read_length(r, "radius");
    return DinnerPlateShape{radius, read_length(r, "thickness", 0.1 * radius)};
  }
  if (kind == "goblet") {
    const Real height = read_length(r, "height"), bowl = read_length(r, "bowl_radius", height);
    return GobletShape{height, bowl, read_length(r, "wall", 0.1 * std::min(bowl, 0.5 * height))};
  }
  if (kind == "torus") {
    const Real radius = read_length(r, "radius");
    return TorusShape{radius, read_length(r, "tube_radius", 0.999 * radius)};
  }
  return read_table_piece(kind, r);
}

}  // namespace

ShapeSpec read_shape(const TomlValue& value, const std::string& path, Problems& problems) {
  const std::string allowed = fmt::format("values: {}", word_list(kKinds));
  if (value.kind != TomlValue::Kind::kTable) {
    problems.refuse(value, path, "type: a table, as {kind = \"sphere\", radius = 0.1}");
    return BoxShape{{1, 1, 1}};
  }
  TableReader reader(value, path, problems);
  const TomlValue* kind = reader.require("kind", allowed);
  const std::size_t index = reader.choice("kind", kKinds, kKinds.size());
  // Without a kind there is nothing to hold the other keys against.
  if (!kind || index == kKinds.size()) return BoxShape{{1, 1, 1}};
  ShapeSpec shape = read_kind(kKinds[index], reader);
  reader.finish();
  return shape;
}

SurfaceMesh make_shape(const ShapeSpec& shape, Real edge) {
  return std::visit(
      Overload{
          [&](const BoxShape& s) { return make_box(s.size, edge); },
          [&](const SphereShape& s) { return make_sphere(s.radius, edge); },
          [&](const HollowSphereShape& s) { return make_hollow_sphere(s.radius, s.inner_radius, edge); },
          [&](const PlateShape& s) { return make_plate(s.width, s.depth, s.thickness, edge); },
          [&](const BarShape& s) { return make_bar(s.length, s.height, s.width, edge); },
          [&](const CylinderShape& s) { return make_cylinder(s.radius, s.height, edge); },
          [&](const DinnerPlateShape& s) { return make_dinner_plate(s.radius, s.thickness, edge); },
          [&](const GobletShape& s) { return make_goblet(s.height, s.bowl_radius, s.wall, edge); },
          [&](const TorusShape& s) { return make_torus(s.radius, s.tube_radius, edge); },
          [&](const TumblerShape& s) { return make_tumbler(s.height, s.radius, s.wall, edge); },
          [&](const VaseShape& s) { return make_vase(s.height, s.radius, s.wall, edge); },
          [&](const FigurineShape& s) { return make_figurine(s.height, edge); },
          [&](const TwistedColumnShape& s) { return make_twisted_column(s.width, s.height, s.turn, edge); },
      },
      shape);
}

Real shape_diagonal(const ShapeSpec& shape) {
  const auto round = [](Real radius, Real height) { return norm(Vec3{2 * radius, height, 2 * radius}); };
  return std::visit(
      Overload{
          [](const BoxShape& s) { return norm(s.size); },
          [&](const SphereShape& s) { return round(s.radius, 2 * s.radius); },
          [&](const HollowSphereShape& s) { return round(s.radius, 2 * s.radius); },
          [](const PlateShape& s) {
            return norm(Vec3{s.width, s.depth, s.thickness});
          },
          [](const BarShape& s) {
            return norm(Vec3{s.length, s.height, s.width});
          },
          [&](const CylinderShape& s) { return round(s.radius, s.height); },
          [&](const DinnerPlateShape& s) { return round(s.radius, s.thickness + 0.23 * s.radius); },
          [&](const GobletShape& s) { return round(s.bowl_radius, s.height); },
          [&](const TorusShape& s) { return round(s.radius + s.tube_radius, 2 * s.tube_radius); },
          [&](const TumblerShape& s) { return round(s.radius, s.height); },
          [&](const VaseShape& s) { return round(s.radius, s.height); },
          [&](const FigurineShape& s) { return round(0.305 * s.height, s.height); },
          [](const TwistedColumnShape& s) {  // the widest section is the one turned the nearest to 45 degrees
            const Real a = std::min(std::abs(s.turn), 0.25 * std::numbers::pi);
            const Real across = s.width * (std::cos(a) + std::sin(a));
            return norm(Vec3{across, s.height, across});
          },
      },
      shape);
}

}  // namespace sherd
