"""The most instructions of a call: the longest path through the machine code, bounded by its loops.

machine_code    functions of an image, basic blocks, control flow and call graph
loops           loops of a function: headers, blocks and nesting
source_lines    source lines of an instruction, outermost function last
loop_bounds     the table tests/targets/loop_bounds.csv: bounds of loops, exclusions, and their reasons
whole_numbers   the maximum of a linear program, with a proof checked in exact numbers
longest_path    the longest path of a function, including its calls
proving         the proved figures of a target's public functions
trip_counts     actual turns of loops over the embedded logs, counted under QEMU by tools/count_plugin
identity        checks that the code is the same without debugging information
"""
