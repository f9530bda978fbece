"""The live page: the library in a browser, compiled to WebAssembly.

modules  builds the modules of port/wasm with CMake
page     combines modules, scripts and style of port/wasm in one file
command  the command: python -m goe_tools live
"""
