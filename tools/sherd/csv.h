// Tables of numbers with a header line, comma separated. Errors (InputError) name the file and the line.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/core/vec3.h"

namespace sherd {

class CsvTable {
 public:
  // Blank lines and a byte order mark are skipped, blanks and quotes around fields are not part of them, quoted fields
  // may hold commas. Every row has as many fields as the header.
  explicit CsvTable(const std::filesystem::path& path);

  std::size_t rows() const { return line_.size(); }
  std::optional<std::size_t> find(std::string_view name) const;  // error when the header has the name twice
  std::size_t column(std::string_view name) const;               // error when the header lacks it
  const std::string& text(std::size_t row, std::size_t column) const { return field_[row * header_.size() + column]; }
  Real number(std::size_t row, std::size_t column) const;        // finite
  long long integer(std::size_t row, std::size_t column) const;  // also written as 3.0

  // FILE:LINE: WHAT
  [[noreturn]] void fail(std::size_t row, const std::string& what) const;
  const std::string& name() const { return name_; }

 private:
  void add_line(std::string_view line, std::size_t number);

  std::string name_;
  std::vector<std::string> header_, field_;
  std::vector<std::size_t> line_;  // of each row, from 1
};

}  // namespace sherd
