# SPDX-FileCopyrightText: 2026 the flocklift authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Bundles the page: cmake -DNODE= -DNPM= -DSOURCE= -DOUT= -DBUILD_PAGE= -P build.cmake. Writes
# page.js, later.js, page.css and missing.txt into OUT; where the page cannot be made, missing.txt says why and
# the others are empty. Without page.stamp the next build tries again.

file(MAKE_DIRECTORY ${OUT}/site)
file(REMOVE ${OUT}/page.stamp)

function(give_up reason)
  message(STATUS "view has no page: ${reason}")
  file(WRITE ${OUT}/missing.txt "${reason}")
  file(WRITE ${OUT}/page.js "")
  file(WRITE ${OUT}/later.js "")
  file(WRITE ${OUT}/page.css "")
endfunction()

if(NOT BUILD_PAGE)
  give_up("flocklift was built with FLOCKLIFT_BUILD_PAGE=OFF; build it with ON.")
  file(TOUCH ${OUT}/page.stamp)
  return()
endif()
if(NOT EXISTS "${NODE}" OR NOT EXISTS "${NPM}")
  give_up("flocklift was built without Node.js; install nodejs and npm, run cmake and build again.")
  return()
endif()

file(COPY ${SOURCE}/src ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/build.mjs
     ${SOURCE}/tsconfig.json DESTINATION ${OUT}/site)
# Sources that went away must not linger: the type check reads the folder.
file(GLOB_RECURSE copies RELATIVE ${OUT}/site ${OUT}/site/src/*)
foreach(copy IN LISTS copies)
  if(NOT EXISTS ${SOURCE}/${copy})
    file(REMOVE ${OUT}/site/${copy})
  endif()
endforeach()

# Fetched once for each lock file. Nothing that a package brings is run.
file(SHA256 ${SOURCE}/package-lock.json lock)
set(fetched "")
if(EXISTS ${OUT}/site/fetched.txt)
  file(READ ${OUT}/site/fetched.txt fetched)
endif()
if(NOT fetched STREQUAL lock)
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1
            --fetch-timeout=60000
    WORKING_DIRECTORY ${OUT}/site RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE errors)
  if(failed)
    give_up("npm could not fetch the page's packages when flocklift was built; build it again when the registry can be reached.")
    message(STATUS "${errors}")
    return()
  endif()
  file(WRITE ${OUT}/site/fetched.txt ${lock})
endif()

execute_process(COMMAND ${NODE} build.mjs ${OUT} WORKING_DIRECTORY ${OUT}/site
                RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the page does not build")
endif()
file(WRITE ${OUT}/missing.txt "")
file(TOUCH ${OUT}/page.stamp)
