#pragma once

namespace isotherm::testing {

// Which sanitizer watches this program. GCC says so by a macro, clang by a feature.
#if defined(__has_feature)
#define ISOTHERM_HAS_FEATURE(feature) __has_feature(feature)
#else
#define ISOTHERM_HAS_FEATURE(feature) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || ISOTHERM_HAS_FEATURE(address_sanitizer)
inline constexpr bool kAddressSanitizer = true;
#else
inline constexpr bool kAddressSanitizer = false;
#endif
#if defined(__SANITIZE_THREAD__) || ISOTHERM_HAS_FEATURE(thread_sanitizer)
inline constexpr bool kThreadSanitizer = true;
#else
inline constexpr bool kThreadSanitizer = false;
#endif
#undef ISOTHERM_HAS_FEATURE

}  // namespace isotherm::testing
