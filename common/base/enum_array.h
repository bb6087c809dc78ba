#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <utility>

namespace isotherm {

/// All values of an enumeration that counts from 0 and ends with kCount, in order.
template <typename Enum>
constexpr auto AllValues() {
  std::array<Enum, static_cast<std::size_t>(Enum::kCount)> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<Enum>(i);
  return values;
}

/// One T for each value of such an enumeration. Thread-compatible.
template <typename Enum, typename T>
class EnumArray {
 public:
  constexpr EnumArray() = default;
  /// Sets what is not listed to T().
  constexpr EnumArray(std::initializer_list<std::pair<Enum, T>> values) {
    for (const auto& [key, value] : values) (*this)[key] = value;
  }

  constexpr T& operator[](Enum key) { return values_[static_cast<std::size_t>(key)]; }
  constexpr const T& operator[](Enum key) const { return values_[static_cast<std::size_t>(key)]; }
  friend constexpr bool operator==(const EnumArray&, const EnumArray&) = default;

 private:
  std::array<T, static_cast<std::size_t>(Enum::kCount)> values_{};
};

}  // namespace isotherm
