#include "kernels/core/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "kernels/core/error.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

// An open file; closes it.
class Descriptor {
 public:
  Descriptor(const fs::path& file, int flags) : fd_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  // Some file systems report a full disk only here.
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

[[noreturn]] void refuse(const fs::path& file, int error) {
  const char* remedy = error == ENOSPC || error == EDQUOT ? "free some space or choose another folder"
                       : error == EFBIG                   ? "raise the limit of file sizes (ulimit -f)"
                                                          : "choose a writable folder";
  throw InputError(fmt::format("{}: cannot be written ({}); {}", file.string(), std::strerror(error), remedy));
}

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

// 0, or the error number. File systems without it (EINVAL) have nothing to bring to a disk.
int flush(const fs::path& file, int flags) {
  const Descriptor open(file, flags);
  if (open.get() < 0) return errno;
  return ::fsync(open.get()) == 0 || errno == EINVAL ? 0 : errno;
}

int write_part(const fs::path& part, std::string_view bytes, Durability durability) {
  Descriptor out(part, O_WRONLY | O_CREAT | O_TRUNC);
  if (out.get() < 0 || !write_all(out.get(), bytes)) return errno;
  if (durability == Durability::kNow && ::fsync(out.get()) != 0 && errno != EINVAL) return errno;
  return out.close() ? 0 : errno;
}

}  // namespace

void replace_file(const fs::path& file, std::string_view bytes, Durability durability) {
  fs::path part = file;
  part += kPartSuffix;
  std::error_code ignored;
  int error = write_part(part, bytes, durability);
  if (error == 0 && std::rename(part.c_str(), file.c_str()) != 0) error = errno;
  if (error != 0) {
    fs::remove(part, ignored);
    refuse(file, error);
  }
  if (durability == Durability::kNow) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    error = flush(folder, O_RDONLY | O_DIRECTORY);
    if (error != 0) refuse(folder, error);
  }
}

void flush_to_disk(std::span<const fs::path> files) {
  for (const fs::path& file : files)
    if (const int error = flush(file, O_RDONLY); error != 0) refuse(file, error);
}

std::string read_bytes(const fs::path& file) {
  const auto fail = [&] {
    throw InputError(fmt::format("{}: cannot be read ({}); check the path and its permissions", file.string(),
                                 std::strerror(errno)));
  };
  const Descriptor in(file, O_RDONLY);
  if (in.get() < 0) fail();
  std::string bytes;
  std::array<char, 1 << 16> buffer;
  for (;;) {
    const ssize_t n = ::read(in.get(), buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail();
    if (n == 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

void make_folder(const fs::path& folder, std::string_view remedy) {
  std::error_code error;
  fs::create_directories(folder, error);
  std::string why = error ? error.message() : "";
  if (!error && !fs::is_directory(folder, error)) why = "a file is in the way";
  if (why.empty() && ::access(folder.c_str(), W_OK | X_OK) != 0) why = std::strerror(errno);
  if (!why.empty())
    throw InputError(fmt::format("{}: cannot write into this folder ({}); {}", folder.string(), why, remedy));
}

}  // namespace sherd
