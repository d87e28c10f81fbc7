#include "engine/scene/toml.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

// The only inclusion of toml++.
#include <toml++/toml.h>

#include "kernels/core/error.h"

namespace sherd {
namespace {

constexpr std::uintmax_t kLargestFile = 16u << 20;  // bytes; a scene is a few kilobytes

TomlValue convert(const toml::node& node) {
  TomlValue value;
  value.line = static_cast<int>(node.source().begin.line);
  value.column = static_cast<int>(node.source().begin.column);
  using Kind = TomlValue::Kind;
  if (const toml::table* table = node.as_table()) {
    value.kind = Kind::kTable;
    for (const auto& [key, child] : *table) {
      const toml::source_position place = key.source().begin;
      value.entries.push_back(
          {std::string(key.str()), static_cast<int>(place.line), static_cast<int>(place.column), convert(child)});
    }
  } else if (const toml::array* array = node.as_array()) {
    value.kind = Kind::kArray;
    for (const toml::node& child : *array) value.items.push_back(convert(child));
  } else if (const auto* text = node.as_string()) {
    value.kind = Kind::kText;
    value.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.kind = Kind::kInteger;
    value.integer = integer->get();
    value.real = static_cast<double>(value.integer);
  } else if (const auto* real = node.as_floating_point()) {
    value.kind = Kind::kReal;
    value.real = real->get();
  } else if (const auto* flag = node.as_boolean()) {
    value.kind = Kind::kFlag;
    value.flag = flag->get();
  } else {
    value.kind = Kind::kDate;
  }
  return value;
}

std::string read_text(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw InputError(fmt::format("{}: no such file; check the path", file.string()));
  if (std::filesystem::is_directory(status))
    throw InputError(fmt::format("{}: is a folder; name the scene file in it", file.string()));
  if (!std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: is not a regular file; name a TOML scene file", file.string()));
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size == 0)
    throw InputError(fmt::format("{}: the file is empty; a scene needs at least one [[body]]", file.string()));
  if (!error && size > kLargestFile)
    throw InputError(fmt::format("{}: {} bytes are too many for a scene (at most {}); is it a mesh?", file.string(),
                                 size, kLargestFile));
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream.good() && !stream.eof())
    throw InputError(fmt::format("{}: cannot be read; check its permissions", file.string()));
  if (text.empty()) throw InputError(fmt::format("{}: cannot be read; check its permissions", file.string()));
  return text;
}

std::string joined(const std::vector<std::string>& parts, std::string_view open, std::string_view close) {
  std::string text(open);
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? ", " : "") + parts[i];
  text += close;
  return text;
}

}  // namespace

TomlValue parse_toml_file(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  try {
    return convert(toml::parse(std::string_view(text), file.string()));
  } catch (const toml::parse_error& error) {
    const toml::source_position place = error.source().begin;
    throw InputError(
        fmt::format("{}:{}:{}: {}", file.string(), place.line, place.column, std::string_view(error.description())));
  }
}

std::string full_text(const TomlValue& value) {
  using Kind = TomlValue::Kind;
  std::vector<std::string> parts;
  switch (value.kind) {
    case Kind::kText: {
      std::string text;
      for (const char c : value.text) text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
      return '"' + text + '"';
    }
    case Kind::kInteger:
      return fmt::format("{}", value.integer);
    case Kind::kReal:
      return fmt::format("{}", value.real);
    case Kind::kFlag:
      return value.flag ? "true" : "false";
    case Kind::kDate:
      return "(a date or time)";
    case Kind::kArray:
      for (const TomlValue& item : value.items) parts.push_back(full_text(item));
      return joined(parts, "[", "]");
    case Kind::kTable:
      for (const TomlEntry& entry : value.entries) parts.push_back(entry.key + " = " + full_text(entry.value));
      return joined(parts, "{", "}");
  }
  return {};
}

std::string to_text(const TomlValue& value) {
  constexpr std::size_t kLongest = 60;
  std::string text = full_text(value);
  if (text.size() <= kLongest) return text;
  std::size_t end = kLongest - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;  // keep UTF-8 characters whole
  return text.substr(0, end) + "...";
}

}  // namespace sherd
