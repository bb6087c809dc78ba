#pragma once

// Which mutex guards what, in words that clang checks (-Wthread-safety); other compilers read past
// them. Only common/base/mutex.h carries the attributes that its own methods need: the standard
// library's std::mutex does not tell the compiler when it is held.
#if defined(__clang__)
#define ISOTHERM_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define ISOTHERM_THREAD_ATTRIBUTE(x)
#endif

/// The member is read and written only with this mutex held.
#define GUARDED_BY(x) ISOTHERM_THREAD_ATTRIBUTE(guarded_by(x))
/// The function is called with these mutexes held, and leaves them so.
#define REQUIRES(...) ISOTHERM_THREAD_ATTRIBUTE(requires_capability(__VA_ARGS__))
/// The function takes these mutexes itself: whoever holds one of them must not call it.
#define EXCLUDES(...) ISOTHERM_THREAD_ATTRIBUTE(locks_excluded(__VA_ARGS__))

// For classes that are mutexes or hold one.
#define CAPABILITY(x) ISOTHERM_THREAD_ATTRIBUTE(capability(x))
#define SCOPED_CAPABILITY ISOTHERM_THREAD_ATTRIBUTE(scoped_lockable)
#define ACQUIRE(...) ISOTHERM_THREAD_ATTRIBUTE(acquire_capability(__VA_ARGS__))
#define RELEASE(...) ISOTHERM_THREAD_ATTRIBUTE(release_capability(__VA_ARGS__))
