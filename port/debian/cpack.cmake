# The Debian package libgoe-dev: the installed files, and the documents that Debian's policy requires. Included last, by the project.
# Nothing is written here: documents.cmake makes the documents when they are packed.
set(GOE_DEBIAN_MAINTAINER "" CACHE STRING "Who answers for the Debian package, which is not made without: Name <address>")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME goe)
set(CPACK_PACKAGE_VENDOR "the goe authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION} (development files)")
set(CPACK_STRIP_FILES OFF)
set(CPACK_DEBIAN_PACKAGE_NAME libgoe-dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${GOE_DEBIAN_MAINTAINER})
if(CMAKE_LIBRARY_ARCHITECTURE AND CMAKE_INSTALL_LIBDIR MATCHES "/${CMAKE_LIBRARY_ARCHITECTURE}$")
    set(CPACK_DEBIAN_PACKAGE_MULTIARCH same) # CMake 3.31 and newer write it
endif()
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"A small C99 library that turns a detector's bounding boxes of a building, a
truck or a chimney, plus the aircraft's own motion, into the obstacle's
position, size and orientation, each with a 1-sigma uncertainty, and into the
figures that a go-around decision needs.

Static libraries, headers, and what CMake and pkg-config look for.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

install(CODE "
    set(goe_maintainer [==[${GOE_DEBIAN_MAINTAINER}]==])
    set(goe_version ${PROJECT_VERSION})
    set(goe_license [==[${PROJECT_SOURCE_DIR}/LICENSE]==])
    set(goe_documents [==[${PROJECT_BINARY_DIR}/debian]==])
    include([==[${CMAKE_CURRENT_LIST_DIR}/documents.cmake]==])" COMPONENT debian EXCLUDE_FROM_ALL)
set(CPACK_COMPONENTS_ALL Unspecified debian)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)

include(CPack)
