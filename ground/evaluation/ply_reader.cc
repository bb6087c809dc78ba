#include "ground/evaluation/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>

#include "common/base/read_file.h"

namespace isotherm {
namespace {

enum class Format { kAscii, kLittleEndian, kBigEndian };

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct Header {
  Format format = Format::kAscii;
  std::size_t vertices = 0;
  std::vector<std::string> names;
  std::vector<Type> types;
};

constexpr std::size_t SizeOf(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUint8:
      return 1;
    case Type::kInt16:
    case Type::kUint16:
      return 2;
    case Type::kInt32:
    case Type::kUint32:
    case Type::kFloat32:
      return 4;
    case Type::kFloat64:
      return 8;
  }
  return 0;
}

std::optional<Type> TypeFromName(std::string_view name) {
  if (name == "char" || name == "int8") return Type::kInt8;
  if (name == "uchar" || name == "uint8") return Type::kUint8;
  if (name == "short" || name == "int16") return Type::kInt16;
  if (name == "ushort" || name == "uint16") return Type::kUint16;
  if (name == "int" || name == "int32") return Type::kInt32;
  if (name == "uint" || name == "uint32") return Type::kUint32;
  if (name == "float" || name == "float32") return Type::kFloat32;
  if (name == "double" || name == "float64") return Type::kFloat64;
  return std::nullopt;
}

std::string_view NextLine(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  // Files that passed through Windows.
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view NextWord(std::string_view& rest) {
  constexpr std::string_view kSpace = " \t\r\n";
  rest.remove_prefix(std::min(rest.find_first_not_of(kSpace), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kSpace));
  rest.remove_prefix(word.size());
  return word;
}

Status ParseFormat(std::string_view name, Header& header) {
  if (name == "ascii") {
    header.format = Format::kAscii;
  } else if (name == "binary_little_endian") {
    header.format = Format::kLittleEndian;
  } else if (name == "binary_big_endian") {
    header.format = Format::kBigEndian;
  } else {
    return DataLoss(fmt::format("unknown PLY format '{}'", name));
  }
  return OkStatus();
}

Status ParseProperty(std::string_view rest, Header& header) {
  const std::string_view type_name = NextWord(rest);
  const std::optional<Type> type = TypeFromName(type_name);
  if (!type)
    return DataLoss(fmt::format("vertex property of type '{}' is not supported", type_name));
  header.types.push_back(*type);
  header.names.emplace_back(NextWord(rest));
  return OkStatus();
}

// Leaves `rest` at the first byte behind the header.
Result<Header> ParseHeader(std::string_view& rest) {
  if (NextLine(rest) != "ply")
    return Err(DataLoss("not a PLY file (the first line must be 'ply')"));
  Header header;
  std::string_view element;
  while (!rest.empty()) {
    std::string_view line = NextLine(rest);
    const std::string_view keyword = NextWord(line);
    Status status;
    if (keyword == "end_header") {
      if (header.names.empty()) return Err(DataLoss("the PLY file has no vertices"));
      return header;
    }
    if (keyword == "format") status = ParseFormat(NextWord(line), header);
    if (keyword == "element") {
      // Elements before the vertices would have to be read over, lists included; no tool of this
      // field writes them so.
      if (element.empty() && !line.starts_with(" vertex ")) {
        return Err(DataLoss("the first element of the PLY file must be 'vertex'"));
      }
      element = NextWord(line);
      const std::string_view count = NextWord(line);
      if (element == "vertex" &&
          std::from_chars(count.data(), count.data() + count.size(), header.vertices).ec !=
              std::errc()) {
        return Err(DataLoss(fmt::format("'{}' is no number of vertices", count)));
      }
    }
    // Faces follow the vertices and are not read, lists included.
    if (keyword == "property" && element == "vertex") status = ParseProperty(line, header);
    if (!status.ok()) return Err(std::move(status));
  }
  return Err(DataLoss("the PLY header has no end (end_header)"));
}

template <typename T>
float Load(const char* bytes, bool swap) {
  char raw[sizeof(T)];
  std::memcpy(raw, bytes, sizeof(T));
  if (swap) std::reverse(raw, raw + sizeof(T));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return static_cast<float>(value);
}

float LoadAs(Type type, const char* bytes, bool swap) {
  switch (type) {
    case Type::kInt8:
      return Load<std::int8_t>(bytes, swap);
    case Type::kUint8:
      return Load<std::uint8_t>(bytes, swap);
    case Type::kInt16:
      return Load<std::int16_t>(bytes, swap);
    case Type::kUint16:
      return Load<std::uint16_t>(bytes, swap);
    case Type::kInt32:
      return Load<std::int32_t>(bytes, swap);
    case Type::kUint32:
      return Load<std::uint32_t>(bytes, swap);
    case Type::kFloat32:
      return Load<float>(bytes, swap);
    case Type::kFloat64:
      return Load<double>(bytes, swap);
  }
  return 0.0F;
}

Status Truncated(std::size_t expected, std::size_t found) {
  return DataLoss(
      fmt::format("the PLY file is truncated: {} vertices announced, {} found", expected, found));
}

Status ReadBinary(const Header& header, std::string_view bytes, PlyVertices& vertices) {
  std::size_t stride = 0;
  for (const Type type : header.types) stride += SizeOf(type);
  // The count comes from the file: nothing is allocated before the bytes are known to be there.
  if (header.vertices > bytes.size() / stride)
    return Truncated(header.vertices, bytes.size() / stride);
  const bool swap =
      (header.format == Format::kBigEndian) != (std::endian::native == std::endian::big);
  std::size_t offset = 0;
  // Column by column: callers ask for columns by name.
  for (std::size_t p = 0; p < header.types.size(); ++p) {
    std::vector<float>& column = vertices.columns[p];
    column.resize(header.vertices);
    for (std::size_t i = 0; i < header.vertices; ++i) {
      column[i] = LoadAs(header.types[p], bytes.data() + i * stride + offset, swap);
    }
    offset += SizeOf(header.types[p]);
  }
  return OkStatus();
}

Status ReadAscii(const Header& header, std::string_view text, PlyVertices& vertices) {
  for (std::size_t i = 0; i < header.vertices; ++i) {
    for (std::vector<float>& column : vertices.columns) {
      const std::string_view word = NextWord(text);
      if (word.empty()) return Truncated(header.vertices, i);
      double value = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size()) {
        return DataLoss(fmt::format("vertex {}: '{}' is not a number", i, word));
      }
      column.push_back(static_cast<float>(value));
    }
  }
  return OkStatus();
}

}  // namespace

const std::vector<float>* PlyVertices::Find(std::string_view name) const {
  // CloudCompare writes its fields with this prefix, other programs without it.
  constexpr std::string_view kPrefix = "scalar_";
  const std::string_view bare = name.starts_with(kPrefix) ? name.substr(kPrefix.size()) : name;
  for (const std::string& candidate :
       {std::string(name), std::string(kPrefix).append(bare), std::string(bare)}) {
    const auto it = std::find(names.begin(), names.end(), candidate);
    if (it != names.end()) return &columns[static_cast<std::size_t>(it - names.begin())];
  }
  return nullptr;
}

Result<PlyVertices> ParsePly(std::string_view bytes) {
  const Result<Header> header = ParseHeader(bytes);
  if (!header) return Err(header.error());
  PlyVertices vertices;
  vertices.count = header->vertices;
  vertices.names = header->names;
  vertices.columns.resize(header->names.size());
  Status status = header->format == Format::kAscii ? ReadAscii(*header, bytes, vertices)
                                                   : ReadBinary(*header, bytes, vertices);
  if (!status.ok()) return Err(std::move(status));
  return vertices;
}

Result<PlyVertices> ReadPly(const std::filesystem::path& path) {
  const Result<std::string> bytes = ReadFile(path, kMaxPlyBytes);
  if (!bytes) return Err(bytes.error());
  Result<PlyVertices> vertices = ParsePly(*bytes);
  if (!vertices) return Err(vertices.error().WithContext(path.string()));
  return vertices;
}

}  // namespace isotherm
