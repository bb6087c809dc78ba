# Run by `cmake --install`: configurations, systemd units and what they need, with paths that follow the prefix of this
# installation. Set by the caller: SOURCE_DIR, BINARY_DIR, CONFIGURATIONS (files below SOURCE_DIR).
set(prefix ${CMAKE_INSTALL_PREFIX})
set(INSTALL_BIN ${prefix}/bin)
set(INSTALL_DOC ${prefix}/share/doc/isotherm)
set(INSTALL_CONFIG ${prefix}/etc/isotherm)
if(prefix STREQUAL "/usr" OR prefix STREQUAL "/")
  set(INSTALL_CONFIG /etc/isotherm)
endif()

# What somebody has edited is theirs: the shipped file goes beside it.
function(install_configuration shipped)
  get_filename_component(name ${shipped} NAME)
  set(installed $ENV{DESTDIR}${INSTALL_CONFIG}/${name})
  set(rename ${name})
  if(EXISTS ${installed})
    file(SHA256 ${installed} installed_hash)
    file(SHA256 ${shipped} shipped_hash)
    if(NOT installed_hash STREQUAL shipped_hash)
      set(rename ${name}.new)
      message(STATUS "Kept: ${installed} was edited; the new one is ${name}.new")
    endif()
  endif()
  file(INSTALL DESTINATION ${INSTALL_CONFIG} TYPE FILE RENAME ${rename} FILES ${shipped})
endfunction()

foreach(configuration IN LISTS CONFIGURATIONS)
  install_configuration(${SOURCE_DIR}/${configuration})
endforeach()
configure_file(${SOURCE_DIR}/systemd/network.env.in ${BINARY_DIR}/systemd/network.env @ONLY)
install_configuration(${BINARY_DIR}/systemd/network.env)

function(install_unit template unit)
  configure_file(${SOURCE_DIR}/systemd/${template}.in ${BINARY_DIR}/systemd/${unit} @ONLY)
  file(INSTALL DESTINATION ${prefix}/lib/systemd/system TYPE FILE FILES ${BINARY_DIR}/systemd/${unit})
endfunction()

install_unit(isotherm-edge.service isotherm-edge.service)
install_unit(isotherm-ground.service isotherm-ground.service)
# The same for one of several rigs: its name is that of the instance.
set(OF_RIG " of the rig %i")
set(PER_RIG "-%i")
set(EDIT_AS "@NAME")
set(FOR_RIG " --edge-id %i --output %S/isotherm/ground-%i --set console.port=0 $ARGUMENTS")
set(OWN_ARGUMENTS "# ARGUMENTS, what differs from ground.textproto for this rig: \"--set console.port=8081 --threads 1\".
EnvironmentFile=-${INSTALL_CONFIG}/ground-%i.env
")
install_unit(isotherm-ground.service isotherm-ground@.service)
file(INSTALL DESTINATION ${prefix}/lib/sysusers.d TYPE FILE RENAME isotherm.conf
  FILES ${SOURCE_DIR}/systemd/isotherm.sysusers)
file(INSTALL DESTINATION ${prefix}/lib/sysctl.d TYPE FILE RENAME 60-isotherm.conf
  FILES ${SOURCE_DIR}/systemd/60-isotherm.sysctl)
message(STATUS "The services use the network that ${INSTALL_CONFIG}/network.env names: this computer only, unless "
  "somebody chose another")
