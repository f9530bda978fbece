"""The page in which the library runs, compiled to WebAssembly.

modules  builds the modules of port/wasm with CMake
page     puts modules, scripts and style of port/wasm into one file
command  the command: python -m goe_tools live
"""
