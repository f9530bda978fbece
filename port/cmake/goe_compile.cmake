# How this project compiles its own C. Users of lib/ need none of it.

set(goe_warnings
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wfloat-equal -Wundef
    -Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition -Wcast-align -Wcast-qual -Wpointer-arith
    -Wwrite-strings -Wswitch-enum -Wvla
    $<$<C_COMPILER_ID:GNU>:-Wlogical-op -Wduplicated-cond -Wduplicated-branches>
    $<$<BOOL:${GOE_WERROR}>:-Werror>)

# Together with IEEE 754 single precision these give the same bits on every target.
set(goe_arithmetic -ffp-contract=off -fno-math-errno)

set(goe_sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)

# goe_library_sources(<variable>): the sources of the library, those in folders of lib/ too
function(goe_library_sources variable)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/*.c)
    set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# goe_compile(<target> [LIBRARY]): C99 and warnings; LIBRARY: the rules of lib/ alone.
function(goe_compile target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "LIBRARY" "" "")
    set_target_properties(${target} PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
    target_compile_options(${target} PRIVATE ${goe_warnings})
    if(arg_LIBRARY AND GOE_FAST_MATH)
        target_compile_options(${target} PRIVATE -O3 -ffast-math)
        target_link_options(${target} INTERFACE -ffast-math)
    else()
        target_compile_options(${target} PRIVATE ${goe_arithmetic})
    endif()
    if(arg_LIBRARY)
        target_compile_options(${target} PRIVATE $<$<C_COMPILER_ID:GNU>:-Wunsuffixed-float-constants>)
        # The same bits wherever the tree lies, with -g, too. In a debug build the debugger is to find the sources.
        foreach(map IN ITEMS ${PROJECT_SOURCE_DIR}=. ${CMAKE_BINARY_DIR}=./build)
            target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-fdebug-prefix-map=${map}>)
        endforeach()
    endif()
    if(GOE_SANITIZE)
        target_compile_options(${target} PRIVATE ${goe_sanitizers})
        target_link_options(${target} PUBLIC ${goe_sanitizers})
        if(arg_LIBRARY)
            # The library never divides by zero and never casts what does not fit; test code may.
            target_compile_options(${target} PRIVATE -fsanitize=float-divide-by-zero,float-cast-overflow
                $<$<C_COMPILER_ID:Clang>:-fsanitize=implicit-conversion>)
            if(CMAKE_C_FLAGS_DEBUG MATCHES -O0) # the tests run the library millions of times
                target_compile_options(${target} PRIVATE -O1)
            endif()
        endif()
    endif()
endfunction()
