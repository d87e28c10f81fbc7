// Checked reading of a TOML table: types, ranges, required and unknown keys. Problems are collected, so that a user
// sees all of them at once; a getter that meets one returns its default.
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/toml.h"
#include "kernels/core/vec3.h"

namespace sherd {

class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}
  void add(int line, int column, const std::string& text);
  // "key: value X not allowed; allowed range Y" at the value's place.
  void refuse(const TomlValue& value, std::string_view key, std::string_view allowed);
  // Throws InputError with all of them in file order, if any.
  void raise() const;
  bool empty() const { return found_.empty(); }

 private:
  std::string file_;
  std::multimap<std::pair<int, int>, std::string> found_;
};

// A range of finite numbers, with its unit for messages.
struct Range {
  Real low, high;
  std::string_view unit = "";
  bool low_open = false, high_open = false;
  bool contains(Real v) const;  // false for NaN
  std::string text() const;     // "0 to 1", "above 0 and up to 10 s"
};

class TableReader {
 public:
  // `path` prefixes keys in messages ("body.material"); empty for the root.
  TableReader(const TomlValue& table, std::string path, Problems& problems);

  const TomlValue* find(std::string_view key);                               // null when absent; marks the key as known
  const TomlValue* require(std::string_view key, std::string_view allowed);  // absent is a problem
  Real number(std::string_view key, const Range& range, Real fallback);
  int integer(std::string_view key, int low, int high, int fallback);
  bool flag(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string_view fallback);
  Vec3 vector(std::string_view key, const Range& range, const Vec3& fallback);
  // Index of the word given; `fallback` when absent.
  std::size_t choice(std::string_view key, std::span<const std::string_view> words, std::size_t fallback);
  // The value must be a table; null otherwise.
  const TomlValue* table(std::string_view key);
  // An array of numbers; nothing (and a problem) when it is none or has fewer than `least`; empty when absent.
  std::optional<std::vector<Real>> numbers(std::string_view key, const Range& range, std::size_t least);
  // The tables of an array [[key]], none when absent; anything else is a problem.
  std::vector<const TomlValue*> tables(std::string_view key);
  // Unknown keys are problems, with the nearest known one. Call after all getters.
  void finish();

  std::string path(std::string_view key) const;
  const TomlValue& value() const { return *table_; }
  Problems& problems() { return *problems_; }

 private:
  const TomlValue* table_;
  std::string path_;
  Problems* problems_;
  std::vector<std::string> known_;
};

// Conversions shared by getters and by keys that take several types; nothing (and a problem) when wrong.
std::optional<Real> to_number(const TomlValue& value, std::string_view key, const Range& range, Problems& problems);
std::optional<Vec3> to_vector(const TomlValue& value, std::string_view key, const Range& range, Problems& problems);
// The word nearest to `word` when near enough to be a slip of the pen; empty otherwise.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> words);
std::string word_list(std::span<const std::string_view> words);

}  // namespace sherd
