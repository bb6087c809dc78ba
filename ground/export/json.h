#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace isotherm {

/// A JSON document to be written: objects keep the order in which keys were first used.
/// Thread-compatible.
///
///   Json stats;
///   stats["frames"]["depth"] = 300;
///   stats["surface"].Append("cloud.ply");
class Json {
 public:
  /// null; becomes an object by operator[] and an array by Append().
  Json() = default;
  Json(bool value) : value_(value) {}
  Json(std::integral auto value) : value_(static_cast<std::int64_t>(value)) {}
  Json(std::floating_point auto value) : value_(static_cast<double>(value)) {}
  Json(std::string value) : value_(std::move(value)) {}
  Json(std::string_view value) : value_(std::string(value)) {}
  Json(const char* value) : value_(std::string(value)) {}

  /// The member `key`, created as null if it is not there. The value must be null or an object.
  Json& operator[](std::string_view key);
  /// The value must be null or an array.
  void Append(Json value);

  /// Indented text, ending in a newline. NaN and infinity are written as null, bytes that are not
  /// UTF-8 as U+FFFD; numbers do not depend on the locale and read back exactly.
  std::string ToText() const;

 private:
  struct Member;
  using Object = std::vector<Member>;
  using Array = std::vector<Json>;
  void Write(int indent, std::string& text) const;

  std::variant<std::monostate, bool, std::int64_t, double, std::string, Object, Array> value_;
};

struct Json::Member {
  std::string key;
  Json value;
};

}  // namespace isotherm
