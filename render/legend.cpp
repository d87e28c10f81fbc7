#include "render/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "render/colour_map.h"

namespace sherd {
namespace {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7;

// Seven rows from the top, five bits each, the left one highest; what a number with its unit is made of.
struct Glyph {
  char letter;
  std::array<std::uint8_t, kGlyphHeight> rows;
};
constexpr Glyph kGlyphs[] = {
    {'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}}, {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'2', {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f}}, {'3', {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e}},
    {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}}, {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
    {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}}, {'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
    {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}}, {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
    {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}}, {'-', {0x00, 0x00, 0x00, 0x1f, 0x00, 0x00, 0x00}},
    {'/', {0x01, 0x01, 0x02, 0x04, 0x08, 0x10, 0x10}}, {'P', {0x1e, 0x11, 0x11, 0x1e, 0x10, 0x10, 0x10}},
    {'J', {0x07, 0x02, 0x02, 0x02, 0x02, 0x12, 0x0c}}, {'M', {0x11, 0x1b, 0x15, 0x15, 0x11, 0x11, 0x11}},
    {'G', {0x0e, 0x11, 0x10, 0x17, 0x11, 0x11, 0x0f}}, {'T', {0x1f, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}},
    {'a', {0x00, 0x00, 0x0e, 0x01, 0x0f, 0x11, 0x0f}}, {'k', {0x10, 0x10, 0x12, 0x14, 0x18, 0x14, 0x12}},
    {'m', {0x00, 0x00, 0x1a, 0x15, 0x15, 0x15, 0x15}}, {'n', {0x00, 0x00, 0x16, 0x19, 0x11, 0x11, 0x11}},
    {'u', {0x00, 0x00, 0x11, 0x11, 0x11, 0x13, 0x0d}}, {'p', {0x00, 0x00, 0x1e, 0x11, 0x1e, 0x10, 0x10}},
};

using Ink = std::array<std::uint8_t, 3>;
constexpr Ink kInk{0x20, 0x24, 0x2c};

void fill(Image& image, int x0, int y0, int width, int height, const Ink& ink) {
  for (int y = std::max(0, y0); y < std::min(image.height, y0 + height); ++y)
    for (int x = std::max(0, x0); x < std::min(image.width, x0 + width); ++x)
      std::copy(
          ink.begin(), ink.end(),
          image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + static_cast<std::ptrdiff_t>(x)));
}

// `dot`: pixels a dot of a glyph is wide.
void write(Image& image, int x, int y, int dot, std::string_view text) {
  for (const char letter : text) {
    const auto glyph =
        std::find_if(std::begin(kGlyphs), std::end(kGlyphs), [&](const Glyph& g) { return g.letter == letter; });
    for (int row = 0; glyph != std::end(kGlyphs) && row < kGlyphHeight; ++row)
      for (int column = 0; column < kGlyphWidth; ++column)
        if (glyph->rows[static_cast<std::size_t>(row)] >> (kGlyphWidth - 1 - column) & 1)
          fill(image, x + column * dot, y + row * dot, dot, dot, kInk);
    x += (kGlyphWidth + 1) * dot;
  }
}

Ink ink_of(float t) {
  const std::array<float, 3> c = map_colour(t);
  Ink ink{};
  for (std::size_t k = 0; k < 3; ++k) ink[k] = static_cast<std::uint8_t>(std::lround(255 * c[k]));
  return ink;
}

}  // namespace

std::string legend_number(Real value, const std::string& unit) {
  constexpr std::string_view kPrefixes[] = {"p", "n", "u", "m", "", "k", "M", "G", "T"};
  constexpr int kPlain = 4;
  int prefix = kPlain;
  if (value != 0 && std::isfinite(value))
    prefix = std::clamp(kPlain + static_cast<int>(std::floor(std::log10(std::abs(value)) / 3)), 0, 8);
  const Real scaled = value / std::pow(1000.0, prefix - kPlain);
  return fmt::format("{:.3g} {}{}", scaled, kPrefixes[prefix], unit);
}

void draw_legend(const FieldScale& scale, Image& image) {
  const int dot = std::max(1, image.height / 320), height = image.height / 2, width = 10 * dot;
  if (image.height < 160 || image.width < 20 * width) return;
  const int left = 2 * width, top = height / 2;
  fill(image, left - dot, top - dot, width + 2 * dot, height + 2 * dot, kInk);
  for (int y = 0; y < height; ++y)
    fill(image, left, top + y, width, 1, ink_of(1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(height)));
  const int text = left + width + 3 * dot, half = kGlyphHeight * dot / 2;
  write(image, text, top - half, dot, legend_number(scale.high, scale.unit));
  write(image, text, top + height - half, dot, legend_number(scale.low, scale.unit));
}

}  // namespace sherd
