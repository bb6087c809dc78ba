#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

/// Text of bounded length, as the wire has it: an array of char that ends with a zero.
namespace isotherm {

/// The longest prefix of at most `max_bytes` that does not end inside a UTF-8 character.
inline std::string_view CutText(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  std::size_t length = max_bytes;
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
  return text.substr(0, length);
}

/// Copies what fits.
template <std::size_t kSize>
void CopyText(std::string_view text, char (&to)[kSize]) {
  const std::string_view cut = CutText(text.substr(0, text.find('\0')), kSize - 1);
  std::memcpy(to, cut.data(), cut.size());
  to[cut.size()] = '\0';
}

/// Text of a peer; control characters become '?', so that it can be logged and shown.
inline std::string Showable(std::string_view from) {
  std::string text(from);
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, '?');
  return text;
}
template <std::size_t kSize>
std::string ReadText(const char (&from)[kSize]) {
  return Showable({from, strnlen(from, kSize)});
}

}  // namespace isotherm
