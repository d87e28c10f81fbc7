// Whole files on disk: read at once, written so that a file of the final name is always complete.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace sherd {

// Ends the name of a file that is still being written. What a killed program leaves of them may be removed.
inline constexpr std::string_view kPartSuffix = ".part";

// kNow: on the disk itself, with its name, when the call returns, even if the power fails. kSoon: when the system gets
// to it, which loses nothing when only the program is killed.
enum class Durability { kSoon, kNow };

// Writes to a temporary name beside `file`, then renames. Throws InputError naming the file, the reason and the remedy;
// the file of before is then as it was and the temporary one is gone.
void replace_file(const std::filesystem::path& file, std::string_view bytes, Durability durability = Durability::kSoon);

// Brings files (or folders: their lists of names) to the disk itself. Throws InputError naming the one that fails.
void flush_to_disk(std::span<const std::filesystem::path> files);

// Throws InputError naming the file when it cannot be read.
std::string read_bytes(const std::filesystem::path& file);

// The folder with its parents; nothing when it is there. Throws InputError naming it when it cannot be created or
// nothing can be written into it; `remedy` ends the message.
void make_folder(const std::filesystem::path& folder, std::string_view remedy);

}  // namespace sherd
