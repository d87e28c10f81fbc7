// TOML as plain data with places, so that one file alone knows the parser.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sherd {

struct TomlEntry;
struct TomlValue {
  enum class Kind { kText, kInteger, kReal, kFlag, kDate, kArray, kTable };
  Kind kind = Kind::kTable;
  int line = 1, column = 1;        // of the value, from 1
  std::string text;                // kText
  std::int64_t integer = 0;        // kInteger
  double real = 0;                 // kReal and kInteger; may be infinite or NaN
  bool flag = false;               // kFlag
  std::vector<TomlValue> items;    // kArray
  std::vector<TomlEntry> entries;  // kTable, in order of the keys' names
};
struct TomlEntry {
  std::string key;
  int line = 1, column = 1;  // of the key
  TomlValue value;
};

// The root table. Throws InputError for a file that is missing, no file, empty or unreadable, and for bad TOML as
// "file:line:column: message".
TomlValue parse_toml_file(const std::filesystem::path& file);
// As it would stand in a file, on one line, without comments, keys in the order of their names.
std::string full_text(const TomlValue& value);
// The same, shortened to at most about 60 characters, for messages.
std::string to_text(const TomlValue& value);

}  // namespace sherd
