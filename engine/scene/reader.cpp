#include "engine/scene/reader.h"

#include <algorithm>
#include <cmath>

#include "kernels/core/error.h"

namespace sherd {
namespace {

// Levenshtein distance, letters only: keys and names are short.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

void Problems::add(int line, int column, const std::string& text) {
  found_.emplace(std::pair{line, column}, text);
}

void Problems::refuse(const TomlValue& value, std::string_view key, std::string_view allowed) {
  add(value.line, value.column, fmt::format("{}: value {} not allowed; allowed {}", key, to_text(value), allowed));
}

void Problems::raise() const {
  if (found_.empty()) return;
  std::string all;
  for (const auto& [place, text] : found_)
    all += fmt::format("{}{}:{}:{}: {}", all.empty() ? "" : "\n", file_, place.first, place.second, text);
  throw InputError(all);
}

bool Range::contains(Real v) const {
  return std::isfinite(v) && (low_open ? v > low : v >= low) && (high_open ? v < high : v <= high);
}

std::string Range::text() const {
  const std::string tail = unit.empty() ? "" : fmt::format(" {}", unit);
  if (!low_open && !high_open) return fmt::format("{:g} to {:g}{}", low, high, tail);
  return fmt::format("{} {:g} and {} {:g}{}", low_open ? "above" : "from", low, high_open ? "below" : "up to", high,
                     tail);
}

std::optional<Real> to_number(const TomlValue& value, std::string_view key, const Range& range, Problems& problems) {
  const bool number = value.kind == TomlValue::Kind::kReal || value.kind == TomlValue::Kind::kInteger;
  if (number && range.contains(value.real)) return value.real;
  problems.refuse(value, key, fmt::format("{}range {}", number ? "" : "type: a number; ", range.text()));
  return std::nullopt;
}

std::optional<Vec3> to_vector(const TomlValue& value, std::string_view key, const Range& range, Problems& problems) {
  if (value.kind != TomlValue::Kind::kArray || value.items.size() != 3) {
    problems.refuse(value, key, fmt::format("type: three numbers [x, y, z]; range {} each", range.text()));
    return std::nullopt;
  }
  Vec3 v;
  bool good = true;
  for (int i = 0; i < 3; ++i) {
    const std::optional<Real> component =
        to_number(value.items[static_cast<std::size_t>(i)], fmt::format("{}[{}]", key, i), range, problems);
    good = good && component;
    v[i] = component.value_or(0);
  }
  return good ? std::optional(v) : std::nullopt;
}

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> words) {
  std::string_view best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string_view candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    // A distance of the candidate's whole length means nothing is left of it.
    if (distance < least && distance < candidate.size()) least = distance, best = candidate;
  }
  return best;
}

std::string word_list(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text += fmt::format("{}{}", text.empty() ? "" : ", ", word);
  return text;
}

TableReader::TableReader(const TomlValue& table, std::string path, Problems& problems)
    : table_(&table), path_(std::move(path)), problems_(&problems) {}

std::string TableReader::path(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

const TomlValue* TableReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  for (const TomlEntry& entry : table_->entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

const TomlValue* TableReader::require(std::string_view key, std::string_view allowed) {
  const TomlValue* value = find(key);
  if (!value) problems_->add(table_->line, table_->column, fmt::format("{}: missing; allowed {}", path(key), allowed));
  return value;
}

Real TableReader::number(std::string_view key, const Range& range, Real fallback) {
  const TomlValue* value = find(key);
  return value ? to_number(*value, path(key), range, *problems_).value_or(fallback) : fallback;
}

int TableReader::integer(std::string_view key, int low, int high, int fallback) {
  const TomlValue* value = find(key);
  if (!value) return fallback;
  const bool whole = value->kind == TomlValue::Kind::kInteger;
  if (whole && value->integer >= low && value->integer <= high) return static_cast<int>(value->integer);
  problems_->refuse(*value, path(key),
                    fmt::format("{}range {} to {}", whole ? "" : "type: a whole number; ", low, high));
  return fallback;
}

bool TableReader::flag(std::string_view key, bool fallback) {
  const TomlValue* value = find(key);
  if (!value) return fallback;
  if (value->kind == TomlValue::Kind::kFlag) return value->flag;
  problems_->refuse(*value, path(key), "values: true, false");
  return fallback;
}

std::string TableReader::text(std::string_view key, std::string_view fallback) {
  const TomlValue* value = find(key);
  if (!value) return std::string(fallback);
  if (value->kind == TomlValue::Kind::kText) return value->text;
  problems_->refuse(*value, path(key), "type: a text in quotes");
  return std::string(fallback);
}

Vec3 TableReader::vector(std::string_view key, const Range& range, const Vec3& fallback) {
  const TomlValue* value = find(key);
  return value ? to_vector(*value, path(key), range, *problems_).value_or(fallback) : fallback;
}

std::size_t TableReader::choice(std::string_view key, std::span<const std::string_view> words, std::size_t fallback) {
  const TomlValue* value = find(key);
  if (!value) return fallback;
  const auto found = std::find(words.begin(), words.end(), std::string_view(value->text));
  if (value->kind == TomlValue::Kind::kText && found != words.end())
    return static_cast<std::size_t>(found - words.begin());
  problems_->refuse(*value, path(key), fmt::format("values: {}", word_list(words)));
  return fallback;
}

const TomlValue* TableReader::table(std::string_view key) {
  const TomlValue* value = find(key);
  if (!value || value->kind == TomlValue::Kind::kTable) return value;
  problems_->refuse(*value, path(key), "type: a table");
  return nullptr;
}

std::optional<std::vector<Real>> TableReader::numbers(std::string_view key, const Range& range, std::size_t least) {
  std::vector<Real> all;
  const TomlValue* value = find(key);
  if (!value) return all;
  if (value->kind != TomlValue::Kind::kArray || value->items.size() < least) {
    problems_->refuse(*value, path(key), fmt::format("type: numbers [a, b, ...], {} or more", least));
    return std::nullopt;
  }
  for (std::size_t i = 0; i < value->items.size(); ++i)
    if (const auto x = to_number(value->items[i], fmt::format("{}[{}]", path(key), i), range, *problems_))
      all.push_back(*x);
  return all.size() == value->items.size() ? std::optional(all) : std::nullopt;
}

std::vector<const TomlValue*> TableReader::tables(std::string_view key) {
  std::vector<const TomlValue*> all;
  const TomlValue* value = find(key);
  if (!value) return all;
  bool good = value->kind == TomlValue::Kind::kArray;
  for (const TomlValue& item : value->items) {
    good = good && item.kind == TomlValue::Kind::kTable;
    all.push_back(&item);
  }
  if (good) return all;
  problems_->refuse(*value, path(key), fmt::format("type: tables, each begun by [[{}]]", path(key)));
  return {};
}

void TableReader::finish() {
  const std::vector<std::string_view> known(known_.begin(), known_.end());
  for (const TomlEntry& entry : table_->entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    const std::string_view near = nearest_word(entry.key, known);
    problems_->add(entry.line, entry.column,
                   near.empty() ? fmt::format("{}: unknown key; known keys: {}", path(entry.key), word_list(known))
                                : fmt::format("{}: unknown key; did you mean '{}'?", path(entry.key), near));
  }
}

}  // namespace sherd
