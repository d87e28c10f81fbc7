#include "kernels/core/archive.h"

#include <cstring>

namespace sherd {

void Archive::raw(void* data, std::size_t size) {
  if (!reading_) {
    written_.append(static_cast<const char*>(data), size);
    return;
  }
  if (size > source_.size()) throw ArchiveError("it ends too early");
  if (size > 0) std::memcpy(data, source_.data(), size);
  source_.remove_prefix(size);
}

std::size_t Archive::count(std::size_t written, std::size_t least) {
  std::uint64_t n = written;
  raw(&n, sizeof(n));
  if (reading_ && n > source_.size() / least) throw ArchiveError("it ends too early");
  return static_cast<std::size_t>(n);
}

void Archive::finish() const {
  if (reading_ && !source_.empty()) throw ArchiveError("it is too long");
}

std::uint64_t digest(std::string_view bytes, std::uint64_t start) {
  std::uint64_t h = start;
  for (const char c : bytes) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return h;
}

}  // namespace sherd
