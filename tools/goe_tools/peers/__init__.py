"""The library beside other solvers and filters of the same problems."""
