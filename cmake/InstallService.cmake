# Run by `cmake --install`: configurations and systemd units, with paths that follow the prefix of this installation.
# Set by the caller: SOURCE_DIR, BINARY_DIR, CONFIGURATIONS (files below SOURCE_DIR).
set(prefix ${CMAKE_INSTALL_PREFIX})
set(INSTALL_BIN ${prefix}/bin)
set(INSTALL_DOC ${prefix}/share/doc/isotherm)
set(INSTALL_CONFIG ${prefix}/etc/isotherm)
if(prefix STREQUAL "/usr" OR prefix STREQUAL "/")
  set(INSTALL_CONFIG /etc/isotherm)
endif()

# What somebody has edited is theirs: the shipped file goes beside it.
foreach(configuration IN LISTS CONFIGURATIONS)
  get_filename_component(name ${configuration} NAME)
  set(installed $ENV{DESTDIR}${INSTALL_CONFIG}/${name})
  set(rename ${name})
  if(EXISTS ${installed})
    file(SHA256 ${installed} installed_hash)
    file(SHA256 ${SOURCE_DIR}/${configuration} shipped_hash)
    if(NOT installed_hash STREQUAL shipped_hash)
      set(rename ${name}.new)
      message(STATUS "Kept: ${installed} was edited; the new one is ${name}.new")
    endif()
  endif()
  file(INSTALL DESTINATION ${INSTALL_CONFIG} TYPE FILE RENAME ${rename}
    FILES ${SOURCE_DIR}/${configuration})
endforeach()

foreach(unit IN ITEMS isotherm-edge.service isotherm-ground.service)
  configure_file(${SOURCE_DIR}/systemd/${unit}.in ${BINARY_DIR}/systemd/${unit} @ONLY)
  file(INSTALL DESTINATION ${prefix}/lib/systemd/system TYPE FILE FILES ${BINARY_DIR}/systemd/${unit})
endforeach()
