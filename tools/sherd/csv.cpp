#include "tools/sherd/csv.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include "engine/mesh/load_raw.h"
#include "kernels/core/error.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(fmt::format("{}: no such file; check the name", path.string()));
  if (fs::is_directory(path, error)) throw InputError(fmt::format("{}: is a folder; name a file in it", path.string()));
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (file && file.peek() != std::ifstream::traits_type::eof()) content << file.rdbuf();
  if (!content || file.bad() || !file.is_open())
    throw InputError(fmt::format("{}: cannot be read; check its permissions", path.string()));
  return std::move(content).str();
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

// False when a quote does not end.
bool split_fields(std::string_view line, std::vector<std::string>& fields) {
  fields.clear();
  for (std::size_t at = 0;;) {
    std::size_t end = line.find(',', at);
    const std::size_t start = line.find_first_not_of(" \t", at);
    if (start != std::string_view::npos && line[start] == '"') {
      const std::size_t close = line.find('"', start + 1);
      if (close == std::string_view::npos) return false;
      fields.emplace_back(line.substr(start + 1, close - start - 1));
      end = line.find(',', close);
    } else {
      fields.emplace_back(trimmed(line.substr(at, end == std::string_view::npos ? end : end - at)));
    }
    if (end == std::string_view::npos) return true;
    at = end + 1;
  }
}

}  // namespace

CsvTable::CsvTable(const fs::path& path) : name_(path.string()) {
  const std::string content = read_file(path);
  std::string_view rest = content;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = trimmed(rest.substr(0, end));
    if (!line.empty()) add_line(line, number);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (header_.empty()) throw InputError(fmt::format("{}: the file is empty; it needs a line with column names", name_));
}

void CsvTable::add_line(std::string_view line, std::size_t number) {
  std::vector<std::string> fields;
  if (!split_fields(line, fields)) throw InputError(fmt::format("{}:{}: a quote does not end", name_, number));
  if (header_.empty()) {
    header_ = std::move(fields);
    return;
  }
  if (fields.size() != header_.size())
    throw InputError(fmt::format("{}:{}: {} fields where the header has {} columns; correct the line", name_, number,
                                 fields.size(), header_.size()));
  field_.insert(field_.end(), fields.begin(), fields.end());
  line_.push_back(number);
}

std::optional<std::size_t> CsvTable::find(std::string_view name) const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header_.size(); ++i) {
    if (header_[i] != name) continue;
    if (found) throw InputError(fmt::format("{}: two columns are named '{}'; rename one", name_, name));
    found = i;
  }
  return found;
}

std::size_t CsvTable::column(std::string_view name) const {
  if (const auto found = find(name)) return *found;
  std::string names;
  for (const std::string& h : header_) names += (names.empty() ? "" : ",") + h;
  throw InputError(fmt::format("{}: no column '{}'; the first line names the columns, it reads '{}'", name_, name,
                               names.substr(0, 120)));
}

void CsvTable::fail(std::size_t row, const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", name_, line_[row], what));
}

Real CsvTable::number(std::size_t row, std::size_t column) const {
  Real value = 0;
  if (!parse_number(text(row, column), value))
    fail(row, fmt::format("{}: '{}' is no number", header_[column], text(row, column)));
  if (!std::isfinite(value)) fail(row, fmt::format("{}: '{}' is not finite", header_[column], text(row, column)));
  return value;
}

long long CsvTable::integer(std::size_t row, std::size_t column) const {
  const Real value = number(row, column);
  if (value != std::floor(value) || std::abs(value) > 1e15)
    fail(row, fmt::format("{}: '{}' is no whole number", header_[column], text(row, column)));
  return static_cast<long long>(value);
}

}  // namespace sherd
