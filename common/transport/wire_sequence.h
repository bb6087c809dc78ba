#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

/// Lists in what idlc generated; for the .cc files of this folder.
namespace isotherm {

/// Released with the wire struct that gets it.
void* AllocateZeroed(std::size_t bytes);

/// Allocates a list for at most `max` of `count` elements in a zeroed wire sequence; returns its
/// elements.
template <typename Sequence>
auto Allocate(Sequence* sequence, std::size_t count, std::size_t max) {
  using Element = std::remove_pointer_t<decltype(sequence->_buffer)>;
  const std::size_t length = std::min(count, max);
  if (length > 0) {
    sequence->_buffer = static_cast<Element*>(AllocateZeroed(length * sizeof(Element)));
  }
  sequence->_maximum = static_cast<std::uint32_t>(length);
  sequence->_length = static_cast<std::uint32_t>(length);
  sequence->_release = true;
  return std::span<Element>(sequence->_buffer, length);
}

template <typename Sequence>
auto Elements(const Sequence& sequence) {
  using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
  return std::span<const Element>(sequence._buffer, sequence._length);
}

}  // namespace isotherm
