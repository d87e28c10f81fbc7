#include "engine/step/checkpoint.h"

#include <algorithm>
#include <cstring>

#include "kernels/core/error.h"
#include "kernels/core/file.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "checkpoint";
constexpr std::string_view kSuffix = ".sherd";
constexpr std::size_t kKept = 2;
constexpr const char* kAnew = "start anew, without --resume";

struct Header {
  std::array<char, 8> magic{'s', 'h', 'e', 'r', 'd', 'r', 'u', 'n'};
  std::uint32_t byte_order = 0x01020304;
  std::uint32_t format = 2;  // raise it when the layout of a file changes
  static constexpr std::size_t kBytes = 16;
};

// Latest first; names sort as steps do.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / kFolder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("step_") && name.ends_with(kSuffix)) files.push_back(entry.path());
  }
  std::sort(files.rbegin(), files.rend());
  return files;
}

// Throws ArchiveError for a damaged file, InputError for a sound one that this program cannot read.
Checkpoint parse(const fs::path& file, std::string_view bytes) {
  Archive a(bytes);
  Header header;
  const Header mine;
  std::uint64_t sum = 0;
  archive(a, header);
  if (header.magic != mine.magic) throw ArchiveError("it is no checkpoint");
  if (header.byte_order != mine.byte_order)
    throw InputError(
        fmt::format("{}: written by a machine of another byte order; resume there, or {}", file.string(), kAnew));
  if (header.format != mine.format)
    throw InputError(
        fmt::format("{}: has format {}, this program reads {}; resume with the program that wrote it, or {}",
                    file.string(), header.format, mine.format, kAnew));
  if (bytes.size() < Header::kBytes + sizeof(sum)) throw ArchiveError("it ends too early");
  const std::string_view body = bytes.substr(0, bytes.size() - sizeof(sum));
  std::memcpy(&sum, bytes.data() + body.size(), sizeof(sum));
  if (digest(body) != sum) throw ArchiveError("its bytes are not those that were written");
  Archive content(body.substr(Header::kBytes));
  Checkpoint c;
  archive(content, c);
  content.finish();
  return c;
}

}  // namespace

void write_checkpoint(const fs::path& folder, const Checkpoint& checkpoint) {
  make_folder(folder / kFolder, "choose a writable folder with --out");
  Checkpoint copy = checkpoint;
  Archive a;
  Header header;
  archive(a, header), archive(a, copy);
  std::string file = a.take();
  const std::uint64_t sum = digest(file);
  file.append(reinterpret_cast<const char*>(&sum), sizeof(sum));
  replace_file(folder / kFolder / fmt::format("step_{:08}{}", checkpoint.step, kSuffix), file, Durability::kNow);
  const std::vector<fs::path> files = files_in(folder);
  std::error_code ignored;
  for (std::size_t i = kKept; i < files.size(); ++i) fs::remove(files[i], ignored);
}

FoundCheckpoint find_checkpoint(const fs::path& folder) {
  FoundCheckpoint found;
  for (const fs::path& file : files_in(folder)) {
    try {
      found.checkpoint = parse(file, read_bytes(file));
      return found;
    } catch (const ArchiveError& e) {
      found.damaged.push_back(fmt::format("{}: damaged ({})", file.string(), e.what()));
    }
  }
  if (!found.damaged.empty())
    throw InputError(fmt::format("{}\nno whole checkpoint is left; {}", fmt::join(found.damaged, "\n"), kAnew));
  return found;
}

void require_same_run(const fs::path& folder, const RunIdentity& written, const RunIdentity& now) {
  const std::string where = (folder / kFolder).string();
  if (written.program != now.program)
    throw InputError(fmt::format("{}: written by {}, but this is {}; resume with that program, or {}", where,
                                 written.program, now.program, kAnew));
  if (written.scene != now.scene)
    throw InputError(
        fmt::format("{}: the scene, or a mesh file it reads, has changed since; put it back, or {}", where, kAnew));
  if (written.options != now.options)
    throw InputError(fmt::format("{}: the run began with the options '{}', not '{}'; give the same, or {}", where,
                                 written.options, now.options, kAnew));
}

void remove_checkpoints(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::path& file : files_in(folder)) fs::remove(file, ignored);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / kFolder, ignored))
    if (entry.path().filename().string().ends_with(std::string(kSuffix) + std::string(kPartSuffix)))
      fs::remove(entry.path(), ignored);
  fs::remove(folder / kFolder, ignored);  // when nothing else is in it
}

}  // namespace sherd
