"""The measured cost of the library on each target.

targets       the presets, and the tools they need
building      a target's build
modules       bytes of code and constants by module, bytes of the state
stack         worst-case stack of each public function
instructions  instructions of each call of a public function, counted under QEMU
longest/      most instructions of a call, proved by the longest path through the machine code
parts         cost of a firmware without some parts of the library
measuring     all figures of a target
book          the ledger's file
growth        figures that grew compared with the ledger
stated        the costs in the public headers
guarantees    the guarantees in README.md, and the targets that meet them
pages         the tables for readers
ledger        the command: python -m ci ledger
flight        the command: python -m ci flight_cost, for the flight layer
"""
