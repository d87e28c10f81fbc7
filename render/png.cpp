#include "render/png.h"

#include <png.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "kernels/core/error.h"

namespace sherd {

void write_png(const std::filesystem::path& path, const Image& image) {
  const auto bytes = 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != bytes)
    throw InputError(fmt::format("{}: cannot write a picture of {}x{} pixels from {} bytes; render it anew",
                                 path.string(), image.width, image.height, image.rgb.size()));
  std::filesystem::path part = path;
  part += ".part";
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  // Half the time of the default filters for files about a tenth larger: frames are written by the hundred.
  header.flags = PNG_IMAGE_FLAG_FAST;
  std::error_code ignored;
  if (!png_image_write_to_file(&header, part.c_str(), 0, image.rgb.data(), 0, nullptr)) {
    const std::string why = header.message;
    png_image_free(&header);
    std::filesystem::remove(part, ignored);
    throw InputError(fmt::format("{}: cannot write the picture ({}); choose a writable output folder with free space",
                                 path.string(), why));
  }
  std::error_code failed;
  std::filesystem::rename(part, path, failed);
  if (failed) {
    std::filesystem::remove(part, ignored);
    throw InputError(fmt::format("{}: cannot write the picture ({}); choose a writable output folder", path.string(),
                                 failed.message()));
  }
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
