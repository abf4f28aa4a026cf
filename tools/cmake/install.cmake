# SPDX-FileCopyrightText: 2026 the flocklift authors
# SPDX-License-Identifier: BSD-3-Clause
#
# `cmake --install`: the program, the libraries of the rooms, their headers under
# include/flocklift/ (but for those that show libav), and what find_package(flocklift) reads.

include(CMakePackageConfigHelpers)

# The library targets of a folder and of those below it.
function(flocklift_targets_below folder result)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(subfolders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  list(FILTER targets INCLUDE REGEX "^flocklift_")
  foreach(subfolder IN LISTS subfolders)
    flocklift_targets_below(${subfolder} below)
    list(APPEND targets ${below})
  endforeach()
  set(${result} ${targets} PARENT_SCOPE)
endfunction()

foreach(room simulate track reconstruct)
  flocklift_targets_below(${PROJECT_SOURCE_DIR}/${room} libraries)
  foreach(library IN LISTS libraries)
    string(REGEX REPLACE "^flocklift_" "" name ${library})
    set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
  endforeach()
  install(TARGETS ${libraries} EXPORT flocklift-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room}
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/flocklift
          FILES_MATCHING PATTERN "*.h"
          PATTERN libav.h EXCLUDE
          PATTERN video_stream.h EXCLUDE)
endforeach()
install(TARGETS flocklift RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/flocklift)
install(EXPORT flocklift-targets NAMESPACE flocklift:: DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/flocklift-config.cmake.in
                              ${PROJECT_BINARY_DIR}/generated/flocklift-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/flocklift-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/flocklift-config.cmake
              ${PROJECT_BINARY_DIR}/generated/flocklift-config-version.cmake
        DESTINATION ${package_dir})
