# For the preset arm64: cross compilation with Debian's g++-aarch64-linux-gnu against arm64 packages that
# deploy/install-deps.sh --arm64 unpacked into build/arm64-sysroot, so that this system's own packages stay as they are.
# Tests run under qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

get_filename_component(CMAKE_SYSROOT ${CMAKE_CURRENT_LIST_DIR}/../build/arm64-sysroot ABSOLUTE)
if(NOT EXISTS ${CMAKE_SYSROOT}/usr/include)
  message(FATAL_ERROR "there are no arm64 packages in ${CMAKE_SYSROOT}: run deploy/install-deps.sh --arm64")
endif()

# Programs (protoc, idlc) are this system's, everything else is the target's.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${CMAKE_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR}
  ${CMAKE_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig)

# An installed system has links to these (alternatives); unpacked packages do not.
set(libraries ${CMAKE_SYSROOT}/usr/lib/aarch64-linux-gnu)
set(alternatives ${libraries}/blas:${libraries}/lapack)
set(CMAKE_EXE_LINKER_FLAGS_INIT -Wl,-rpath-link,${alternatives})

# A processor with NEON and no SVE, as in the computers that rigs have.
set(CMAKE_CROSSCOMPILING_EMULATOR
  qemu-aarch64 -cpu cortex-a72 -L ${CMAKE_SYSROOT} -E LD_LIBRARY_PATH=${alternatives})
