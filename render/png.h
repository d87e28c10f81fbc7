// PNG files through libpng.
#pragma once
#include <filesystem>

#include "render/image.h"

namespace sherd {

// 8-bit sRGB. Written under a temporary name beside `path` and renamed, so a file of that name is always complete.
// Throws InputError naming the file when it cannot be written, and for an image whose bytes do not match its size.
void write_png(const std::filesystem::path& path, const Image& image);

// Any PNG, converted to 8-bit RGB. Throws InputError naming the file when it cannot be read.
Image read_png(const std::filesystem::path& path);

}  // namespace sherd
