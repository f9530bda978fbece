"""The most instructions that a call can take: the longest path through the machine code, bounded by its loops.

machine_code    functions of an image, their basic blocks, what follows what, who calls whom
loops           loops of a function: where they begin, what they hold, which hold others
source_lines    the lines of the sources that an instruction comes from, outermost function last
loop_bounds     the table tests/targets/loop_bounds.csv: how often a loop runs, what excludes what, and why
whole_numbers   the largest sum of a linear program, with a proof that is checked in whole numbers
longest_path    the longest path of a function with all that it calls
proving         the proved figures of a target's public functions
trip_counts     how often the loops do run over the embedded logs, counted under QEMU by tools/count_plugin
identity        the code is the same without the lines that are kept beside it
"""
