# `cmake --install build/release --prefix DIR` and `cpack -G DEB`: programs, manuals, completion, the systemd unit and the pages.
include(GNUInstallDirs)

# Manuals and completion are written by the programs themselves, from the same source as --help.
set(manual_folder ${PROJECT_BINARY_DIR}/manual)
file(MAKE_DIRECTORY ${manual_folder})
set(manual_files "")
foreach(program driftlab driftlabd)
  if(program STREQUAL "driftlab")
    set(page ${manual_folder}/driftlab.1)
  else()
    set(page ${manual_folder}/driftlabd.8)
  endif()
  set(made ${page} ${manual_folder}/${program}.bash ${manual_folder}/_${program} ${manual_folder}/${program}.fish)
  add_custom_command(
    OUTPUT ${made}
    COMMAND ${program} man > ${page}
    COMMAND ${program} completion bash > ${manual_folder}/${program}.bash
    COMMAND ${program} completion zsh > ${manual_folder}/_${program}
    COMMAND ${program} completion fish > ${manual_folder}/${program}.fish
    DEPENDS ${program} COMMENT "Writing manual and completion of ${program}" VERBATIM)
  list(APPEND manual_files ${made})
  install(FILES ${manual_folder}/${program}.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
  install(FILES ${manual_folder}/_${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
  install(FILES ${manual_folder}/${program}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endforeach()
add_custom_target(manuals ALL DEPENDS ${manual_files})

install(TARGETS driftlab driftlabd driftlab-decode RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES ${manual_folder}/driftlab.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${manual_folder}/driftlabd.8 DESTINATION ${CMAKE_INSTALL_MANDIR}/man8)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/driftlab RENAME copyright)
install(FILES README.md CHANGELOG.md NOTICE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/driftlab)
install(DIRECTORY schema/docs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/driftlab/manual FILES_MATCHING PATTERN "*.md")
install(DIRECTORY deploy/prometheus deploy/grafana deploy/ci DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/driftlab/examples)
# The unit names the program where it was installed, which is known only then.
install(CODE "
  file(READ \"${PROJECT_SOURCE_DIR}/deploy/systemd/driftlabd.service\" unit)
  string(REPLACE \"ExecStart=/usr/local/bin/\" \"ExecStart=\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/\" unit \"\${unit}\")
  string(REGEX REPLACE \"# driftlab as a service[^\\n]*\\n\" \"# driftlab as a service:\\n\" unit \"\${unit}\")
  file(WRITE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/systemd/system/driftlabd.service\" \"\${unit}\")
")

# The package: what the programs link is what deploy/packages.sh says (tests/house/packages_test.py holds it to them).
execute_process(COMMAND ${PROJECT_SOURCE_DIR}/deploy/packages.sh runtime OUTPUT_VARIABLE runtime_packages
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE " +" ", " runtime_packages "${runtime_packages}")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME driftlab)
set(CPACK_PACKAGE_VENDOR "The driftlab authors")
set(CPACK_PACKAGE_CONTACT "The driftlab authors <driftlab@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "characterise the stochastic errors of inertial sensors")
set(CPACK_PACKAGE_DESCRIPTION "${PROJECT_DESCRIPTION}.
The command line driftlab and the daemon driftlabd, which serves the same over HTTP with the lab's pages.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_SET_DESTDIR ON)  # so that what is installed knows its prefix
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libc6, libgcc-s1, ${runtime_packages}")
include(CPack)
