#include <algorithm>
#include <array>
#include <cmath>

#include "engine/scene/load_body.h"

namespace sherd {
namespace {

constexpr std::array<std::string_view, 5> kKinds{"noise", "layers", "grains", "attribute", "share"};
constexpr int kLargestSeed = 2147483647;

// After a problem the least value, which makes the field no worse than it is.
Real read_required(TableReader& reader, std::string_view key, const Range& range) {
  reader.require(key, fmt::format("range {}", range.text()));
  return reader.number(key, range, range.low);
}

std::uint64_t read_seed(TableReader& reader) {
  return static_cast<std::uint64_t>(reader.integer("seed", 0, kLargestSeed, 0));
}

FieldSpec read_noise(TableReader& reader, const Range& range, Real mean) {
  NoiseSpec noise;
  noise.mean = reader.number("mean", range, mean);
  noise.lognormal = reader.flag("lognormal", false);
  const Range linear{0, 1, "of the mean", false, true}, exponent{0, 5, "(the exponent's)"};
  noise.amplitude = read_required(reader, "amplitude", noise.lognormal ? exponent : linear);
  noise.wavelength = read_required(reader, "wavelength", kLength);
  noise.seed = read_seed(reader);
  return noise;
}

std::optional<FieldSpec> read_layers(TableReader& reader, const Range& range) {
  LayerSpec layers;
  layers.axis = normalized(read_direction(reader, "axis", layers.axis));
  layers.blend = reader.number("blend", {0, kLength.high, "m"}, 0);
  const TomlValue* offsets = reader.require("offsets", "type: numbers [a, b, ...], ascending");
  const TomlValue* values = reader.require("values", "type: one number more than offsets");
  const auto places = reader.numbers("offsets", kCoordinate, 1);
  const auto amounts = reader.numbers("values", range, 2);
  if (!offsets || !values || !places || !amounts) return std::nullopt;
  layers.offsets = *places, layers.values = *amounts;
  if (layers.values.size() != layers.offsets.size() + 1) {
    reader.problems().refuse(*values, reader.path("values"),
                             fmt::format("count: {}, one more than offsets", layers.offsets.size() + 1));
    return std::nullopt;
  }
  const auto too_near = [&](Real a, Real b) { return !(b > a) || b - a < layers.blend; };
  if (std::adjacent_find(places->begin(), places->end(), too_near) == places->end()) return layers;
  reader.problems().refuse(*offsets, reader.path("offsets"), "order: ascending, at least `blend` apart");
  return std::nullopt;
}

FieldSpec read_grains(TableReader& reader, const Range& range, Real mean) {
  GrainSpec grains;
  grains.mean = reader.number("mean", range, mean);
  grains.size = read_required(reader, "size", kLength);
  grains.spread = reader.number("spread", {0, 1, "of the mean", false, true}, 0);
  grains.boundary = reader.number("boundary", {0, 10, "of the grain's", true}, 1);
  grains.width = reader.number("width", {0, kWidestBoundary, "of the size"}, grains.width);
  grains.seed = read_seed(reader);
  return grains;
}

FieldSpec read_attribute(TableReader& reader, const Range& range) {
  AttributeSpec attribute;
  reader.require("name", "type: the name of a vertex attribute of the mesh, in quotes");
  attribute.name = reader.text("name", "");
  attribute.low = read_required(reader, "low", range);
  attribute.high = read_required(reader, "high", range);
  return attribute;
}

std::optional<FieldSpec> read_kind(std::string_view kind, TableReader& reader, const Range& range, Real mean) {
  if (kind == "noise") return read_noise(reader, range, mean);
  if (kind == "layers") return read_layers(reader, range);
  if (kind == "grains") return read_grains(reader, range, mean);
  if (kind == "attribute") return read_attribute(reader, range);
  return ShareSpec{read_required(reader, "factor", {0, 1, "of the strength", true})};
}

}  // namespace

std::optional<FieldSpec> read_field(const TomlValue& value, const std::string& path, const Range& range, Real mean,
                                    bool whole, Problems& problems) {
  TableReader reader(value, path, problems);
  const std::span<const std::string_view> kinds(kKinds.data(), kKinds.size() - (whole ? 0 : 1));
  const std::string allowed = fmt::format("values: {}", word_list(kinds));
  const TomlValue* kind = reader.require("kind", allowed);
  const std::size_t index = reader.choice("kind", kinds, kinds.size());
  if (!kind || index == kinds.size()) return std::nullopt;
  if (!range.contains(mean) && (index == 0 || index == 2) &&
      !reader.require("mean", fmt::format("range {}", range.text())))
    return std::nullopt;
  const std::optional<FieldSpec> spec = read_kind(kinds[index], reader, range, mean);
  reader.finish();
  if (!spec || std::holds_alternative<ShareSpec>(*spec)) return spec;
  const FieldBounds bounds = bounds_of(*spec, {});
  if (range.contains(bounds.lower) && range.contains(bounds.upper)) return spec;
  problems.refuse(
      value, path,
      fmt::format("range {} at every place; the field spans {:g} to {:g}", range.text(), bounds.lower, bounds.upper));
  return std::nullopt;
}

}  // namespace sherd
