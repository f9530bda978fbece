"""The library beside other solvers of the same problems: speed and size, on this machine and on a Cortex-M4F.

job           what a problem, its cases and its solvers are
window        problem: the window's fit
update        problem: the refined filter's measurement update
lower_bound   how few operations such an update can do with
others        whose solvers can be had here
build         programs for this machine and images for the Cortex-M4F
measure       runs them: nanoseconds, instructions, stack, code, error of the answers
throughput    updates per second of the whole library on one core
command       the command line and the tables
"""
