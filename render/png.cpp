#include "render/png.h"

#include <png.h>

#include "kernels/core/error.h"
#include "kernels/core/file.h"

namespace sherd {

void write_png(const std::filesystem::path& path, const Image& image) {
  const auto bytes = 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != bytes)
    throw InputError(fmt::format("{}: cannot write a picture of {}x{} pixels from {} bytes; render it anew",
                                 path.string(), image.width, image.height, image.rgb.size()));
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  // Half the time of the default filters for files about a tenth larger: frames are written by the hundred.
  header.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string file(size, '\0');
  if (!png_image_write_to_memory(&header, file.data(), &size, 0, image.rgb.data(), 0, nullptr)) {
    const std::string why = header.message;
    png_image_free(&header);
    throw InputError(fmt::format("{}: cannot make the picture ({}); make it smaller", path.string(), why));
  }
  replace_file(path, std::string_view(file).substr(0, size));
}

Image read_png(const std::filesystem::path& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  Image image;
  bool ok = png_image_begin_read_from_file(&header, path.c_str()) != 0;
  if (ok) {
    header.format = PNG_FORMAT_RGB;
    image.width = static_cast<int>(header.width), image.height = static_cast<int>(header.height);
    image.rgb.resize(PNG_IMAGE_SIZE(header));
    ok = png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr) != 0;
  }
  const std::string why = header.message;
  png_image_free(&header);
  if (!ok) throw InputError(fmt::format("{}: cannot read the picture ({}); give a PNG file", path.string(), why));
  return image;
}

}  // namespace sherd
