#include "ground/export/json.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/check.h"

namespace isotherm {
namespace {

constexpr std::string_view kReplacement = "\uFFFD";

/// Length of the well-formed UTF-8 sequence at the start of `text`; 0 if there is none (RFC 3629).
std::size_t SequenceLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool surrogate = first == 0xED && byte(1) > 0x9F;
  const bool beyond_unicode = first == 0xF4 && byte(1) > 0x8F;
  return overlong || surrogate || beyond_unicode ? 0 : length;
}

void WriteString(std::string_view value, std::string& text) {
  text += '"';
  while (!value.empty()) {
    const std::size_t length = SequenceLength(value);
    const auto first = static_cast<unsigned char>(value.front());
    if (length == 0) {
      text += kReplacement;
    } else if (first == '"' || first == '\\') {
      text += '\\';
      text += value.front();
    } else if (first < 0x20) {
      text += fmt::format("\\u{:04x}", static_cast<unsigned>(first));
    } else {
      text += value.substr(0, length);
    }
    value.remove_prefix(length == 0 ? 1 : length);
  }
  text += '"';
}

void NewLine(int indent, std::string& text) {
  text += '\n';
  text.append(static_cast<std::size_t>(indent) * 2, ' ');
}

}  // namespace

Json& Json::operator[](std::string_view key) {
  if (std::holds_alternative<std::monostate>(value_)) value_ = Object{};
  CHECK(std::holds_alternative<Object>(value_));
  Object& object = std::get<Object>(value_);
  for (Member& member : object) {
    if (member.key == key) return member.value;
  }
  object.push_back({std::string(key), Json()});
  return object.back().value;
}

void Json::Append(Json value) {
  if (std::holds_alternative<std::monostate>(value_)) value_ = Array{};
  CHECK(std::holds_alternative<Array>(value_));
  std::get<Array>(value_).push_back(std::move(value));
}

std::string Json::ToText() const {
  std::string text;
  Write(0, text);
  return text + "\n";
}

void Json::Write(int indent, std::string& text) const {
  if (const auto* flag = std::get_if<bool>(&value_)) {
    text += *flag ? "true" : "false";
  } else if (const auto* integer = std::get_if<std::int64_t>(&value_)) {
    text += fmt::format("{}", *integer);
  } else if (const auto* number = std::get_if<double>(&value_)) {
    text += std::isfinite(*number) ? fmt::format("{}", *number) : "null";
  } else if (const auto* string = std::get_if<std::string>(&value_)) {
    WriteString(*string, text);
  } else if (const auto* object = std::get_if<Object>(&value_)) {
    text += '{';
    for (const Member& member : *object) {
      if (&member != &object->front()) text += ',';
      NewLine(indent + 1, text);
      WriteString(member.key, text);
      text += ": ";
      member.value.Write(indent + 1, text);
    }
    if (!object->empty()) NewLine(indent, text);
    text += '}';
  } else if (const auto* array = std::get_if<Array>(&value_)) {
    text += '[';
    for (const Json& element : *array) {
      if (&element != &array->front()) text += ',';
      NewLine(indent + 1, text);
      element.Write(indent + 1, text);
    }
    if (!array->empty()) NewLine(indent, text);
    text += ']';
  } else {
    text += "null";
  }
}

}  // namespace isotherm
