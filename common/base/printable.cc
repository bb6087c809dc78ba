#include "common/base/printable.h"

#include <cstdint>

namespace isotherm {
namespace {

/// Bytes of the UTF-8 character that `text` starts with, and the character; 0 if it is none.
std::size_t DecodeCharacter(std::string_view text, std::uint32_t& character) {
  const auto byte = [&text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  const std::size_t size = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : 4;
  // Longer forms of shorter characters are forbidden in UTF-8: they are used to smuggle in
  // characters that filters look for.
  constexpr std::uint32_t kFirstOfSize[] = {0, 0, 0x80, 0x800, 0x10000};
  if (size == 4 && first >> 3 != 30) return 0;
  if (text.size() < size) return 0;
  character = size == 1 ? first : first & (0x7FU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if (byte(i) >> 6 != 2) return 0;
    character = character << 6 | (byte(i) & 0x3FU);
  }
  const bool is_surrogate = character >= 0xD800 && character < 0xE000;
  return character < kFirstOfSize[size] || character > 0x10FFFF || is_surrogate ? 0 : size;
}

bool IsHarmless(std::uint32_t character) {
  const bool is_control = character < 0x20 || (character >= 0x7F && character < 0xA0);
  const bool is_separator = character == 0x2028 || character == 0x2029;
  const bool is_direction = (character >= 0x202A && character <= 0x202E) ||
                            (character >= 0x2066 && character <= 0x2069) || character == 0x200E ||
                            character == 0x200F || character == 0x061C;
  return !is_control && !is_separator && !is_direction;
}

void AppendEscaped(std::string_view bytes, std::string& out) {
  constexpr char kDigits[] = "0123456789abcdef";
  for (const char c : bytes) {
    const auto byte = static_cast<std::uint8_t>(c);
    out += "\\x";
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
}

std::string Escaped(std::string_view text, bool keep_line_breaks) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    std::uint32_t character = 0;
    const std::size_t size = DecodeCharacter(text, character);
    // Damaged text is escaped byte by byte until a character begins again.
    const std::string_view bytes = text.substr(0, size == 0 ? 1 : size);
    text.remove_prefix(bytes.size());
    if (bytes == "\n") {
      out += keep_line_breaks ? "\n" : "\\n";
    } else if (size > 0 && IsHarmless(character)) {
      out += bytes;
    } else {
      AppendEscaped(bytes, out);
    }
  }
  return out;
}

}  // namespace

std::string Printable(std::string_view text) { return Escaped(text, false); }

std::string PrintableLines(std::string_view text) { return Escaped(text, true); }

}  // namespace isotherm
