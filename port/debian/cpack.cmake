# The Debian package libgoe-dev: what is installed, and what Debian's policy asks beside it. Included last, by the project.
set(GOE_DEBIAN_MAINTAINER "the goe authors <authors@goe.invalid>" CACHE STRING "Who answers for the Debian package: Name <address>")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME goe)
set(CPACK_PACKAGE_VENDOR "the goe authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "estimator of ground obstacles for flight controllers (development files)")
set(CPACK_STRIP_FILES OFF)
set(CPACK_DEBIAN_PACKAGE_NAME libgoe-dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${GOE_DEBIAN_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"A small C99 library that turns a detector's bounding boxes of a building, a
truck or a chimney, plus the aircraft's own motion, into where the obstacle
is, how big it is and how it stands, each with its one sigma, and into the
figures that a go-around decision needs.

Static libraries, headers, and what CMake and pkg-config look for.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# Policy asks for both of these in every package.
set(documents ${CMAKE_BINARY_DIR}/debian)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE licence)
string(STRIP "${licence}" licence)
string(REGEX REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REGEX REPLACE "\n" "\n " licence "${licence}")
file(WRITE ${documents}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\nFiles: *\n"
    "Copyright: 2026 the goe authors\nLicense: MIT\n ${licence}\n")
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC) # SOURCE_DATE_EPOCH, if it is set
file(WRITE ${documents}/changelog "goe (${PROJECT_VERSION}-1) unstable; urgency=medium\n\n  * Version ${PROJECT_VERSION}.\n\n"
    " -- ${GOE_DEBIAN_MAINTAINER}  ${now}\n")
find_program(GZIP gzip)
if(GZIP)
    execute_process(COMMAND ${GZIP} -9 -n -c ${documents}/changelog OUTPUT_FILE ${documents}/changelog.Debian.gz
        COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${documents}/copyright ${documents}/changelog.Debian.gz DESTINATION share/doc/libgoe-dev
        COMPONENT debian EXCLUDE_FROM_ALL)
endif()
set(CPACK_COMPONENTS_ALL Unspecified debian)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_DEBIAN_PACKAGE_NAME libgoe-dev)

include(CPack)
