# WebAssembly by Debian's clang-19, lld-19 and binaryen: no C library, no runtime. Needs what every browser has since 2021: bulk memory and
# conversions that do not trap.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_EXECUTABLE_SUFFIX_C .wasm)

find_program(GOE_WASM_CLANG NAMES clang-19 REQUIRED)
find_program(GOE_WASM_LD NAMES wasm-ld-19 REQUIRED)
find_program(GOE_WASM_OPT NAMES wasm-opt REQUIRED)
set(CMAKE_C_COMPILER ${GOE_WASM_CLANG})
set(CMAKE_C_COMPILER_TARGET wasm32-unknown-unknown)
set(CMAKE_C_FLAGS_INIT "-ffreestanding -isystem ${CMAKE_CURRENT_LIST_DIR}/include -mbulk-memory -mnontrapping-fptoint -mmutable-globals -msign-ext")
set(CMAKE_C_FLAGS_RELEASE "" CACHE STRING "Optimization: -Oz, -Os or -O2")

# Not through clang, which would run wasm-opt by itself where that is found, with options of its own.
set(CMAKE_C_LINK_EXECUTABLE "${GOE_WASM_LD} <LINK_FLAGS> <OBJECTS> -o <TARGET>")
