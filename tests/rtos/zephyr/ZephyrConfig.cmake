# A stand-in for Zephyr's CMake package on the host: only the functions that port/zephyr calls. Names and arguments were
# compared with Zephyr 3.4.0 on 2026-11-22. STAND_IN_CONFIG is a folder with config.cmake and autoconf.h.

project(stand_in_zephyr LANGUAGES C)
include(${STAND_IN_CONFIG}/config.cmake)

add_library(zephyr_interface INTERFACE)
target_include_directories(zephyr_interface SYSTEM INTERFACE ${CMAKE_CURRENT_LIST_DIR}/include)
target_compile_options(zephyr_interface INTERFACE
    -std=gnu99 -imacros ${STAND_IN_CONFIG}/autoconf.h -Wall -Wextra -Wundef -Wshadow -Werror)
find_package(Threads REQUIRED)
add_executable(app ${CMAKE_CURRENT_LIST_DIR}/stand_in.c)
target_link_libraries(app PRIVATE zephyr_interface Threads::Threads m)

function(zephyr_include_directories)
    target_include_directories(zephyr_interface INTERFACE ${ARGN})
endfunction()

function(zephyr_compile_definitions)
    target_compile_definitions(zephyr_interface INTERFACE ${ARGN})
endfunction()

# All of its objects are in the image, as with Zephyr's --whole-archive.
macro(zephyr_library_named name)
    set(ZEPHYR_CURRENT_LIBRARY ${name})
    add_library(${name} OBJECT)
    target_link_libraries(${name} PRIVATE zephyr_interface)
    target_link_libraries(app PRIVATE ${name})
endmacro()

function(zephyr_library_sources)
    target_sources(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
endfunction()

function(zephyr_library_compile_definitions)
    target_compile_definitions(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
endfunction()

function(zephyr_library_compile_options)
    target_compile_options(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
endfunction()

foreach(module IN LISTS ZEPHYR_EXTRA_MODULES EXTRA_ZEPHYR_MODULES)
    file(STRINGS ${module}/zephyr/module.yml lines REGEX "^  cmake: ")
    string(REGEX REPLACE "^  cmake: " "" folder "${lines}")
    add_subdirectory(${module}/${folder} ${CMAKE_BINARY_DIR}/module)
endforeach()
