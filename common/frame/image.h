#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/base/check.h"

namespace isotherm {

/// Contiguous row-major image, height x width. What a value means is said where the image is
/// declared.
template <typename T>
class Image {
 public:
  using value_type = T;

  Image() = default;
  Image(int width, int height, T value = T{}) : width_(width), height_(height) {
    CHECK(width >= 0 && height >= 0);
    Allocate(value);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return pixels_.size(); }
  bool empty() const { return pixels_.empty(); }

  T& At(int x, int y) {
    DCHECK(Contains(x, y));
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)];
  }
  const T& At(int x, int y) const { return const_cast<Image*>(this)->At(x, y); }
  bool Contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

  std::span<T> Row(int y) {
    return {pixels_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_),
            static_cast<std::size_t>(width_)};
  }
  std::span<const T> Row(int y) const {
    return {pixels_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_),
            static_cast<std::size_t>(width_)};
  }
  std::span<T> pixels() { return pixels_; }
  std::span<const T> pixels() const { return pixels_; }
  T* data() { return pixels_.data(); }
  const T* data() const { return pixels_.data(); }

  void Fill(T value) { pixels_.assign(pixels_.size(), value); }
  /// Changes the size; contents are undefined unless the size stays the same.
  void Resize(int width, int height) {
    CHECK(width >= 0 && height >= 0);
    width_ = width;
    height_ = height;
    Allocate(T{});
  }

  friend bool operator==(const Image&, const Image&) = default;

 private:
  /// Where masked loads are not a machine instruction, kernels read a whole vector beyond the last
  /// pixel: there is memory.
  static constexpr std::size_t kSlackBytes = 64;

  void Allocate(T value) {
    const std::size_t size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    if (size > pixels_.capacity()) pixels_.reserve(size + kSlackBytes / sizeof(T));
    pixels_.resize(size, value);
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

}  // namespace isotherm
