"""Speed and size of the library and of other solvers of the same problems, on this machine and on a Cortex-M4F.

job           a problem with its cases and solvers
window        problem: the window's fit
update        problem: the filter's measurement update
lower_bound   minimum number of operations of such an update
others        solvers that are installed here
build         programs for this machine and images for the Cortex-M4F
measure       runs them: nanoseconds, instructions, stack, code, error of the answers
throughput    updates per second of the whole library on one core
command       the command line and the tables
"""
