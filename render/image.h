// A finished picture.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sherd {

struct Image {
  int width = 0, height = 0;      // pixels
  std::vector<std::uint8_t> rgb;  // 3 width height bytes, sRGB, top row first

  // Three bytes; x to the right, y down.
  const std::uint8_t* pixel(int x, int y) const& {
    return rgb.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
  const std::uint8_t* pixel(int x, int y) const&& = delete;  // would point into a dead picture
  friend bool operator==(const Image&, const Image&) = default;
};

}  // namespace sherd
