# The Unity test framework, as the target unity::framework. In this order: sources named by -DUNITY_DIR=, an installed
# CMake package, what tools/fetch_unity.sh has fetched. Nothing is downloaded from here. Where
# none of them is, there is no target.

set(UNITY_DIR "" CACHE PATH "Folder of unity.c, or the one whose src/ has it")

# goe_unity_from(<folder>): the target, if the folder has the sources
function(goe_unity_from folder)
    foreach(candidate ${folder} ${folder}/src)
        if(NOT TARGET unity::framework AND EXISTS ${candidate}/unity.c)
            add_library(goe_unity STATIC ${candidate}/unity.c)
            target_include_directories(goe_unity SYSTEM PUBLIC ${candidate})
            add_library(unity::framework ALIAS goe_unity)
            message(STATUS "Unity: ${candidate}")
        endif()
    endforeach()
endfunction()

if(UNITY_DIR)
    goe_unity_from(${UNITY_DIR})
    if(NOT TARGET unity::framework)
        message(FATAL_ERROR "UNITY_DIR=${UNITY_DIR}: neither it nor its src/ has a file unity.c")
    endif()
endif()
if(NOT TARGET unity::framework)
    find_package(unity CONFIG QUIET)
    if(TARGET unity::framework)
        message(STATUS "Unity: ${unity_DIR}")
    endif()
endif()
if(NOT TARGET unity::framework)
    goe_unity_from(${PROJECT_SOURCE_DIR}/.cache/unity)
endif()
