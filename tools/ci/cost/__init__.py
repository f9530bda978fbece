"""What the library costs on each target, measured, not estimated.

targets       the presets, and what each of them needs
building      a target's build
modules       bytes of code and constants by module, bytes of the state
stack         worst-case stack of each public function
instructions  instructions of each call of a public function, counted one by one under QEMU
longest/      the most instructions that a call can take, proved by the longest path through the machine code
parts         what a firmware pays that leaves parts of the library out
measuring     all figures of a target
book          the ledger's file
growth        what grew over the ledger
stated        what goe.h states of each function
guarantees    what README.md promises, and on which targets it holds
pages         the tables that people read
ledger        the command: python -m ci ledger
flight        the command: python -m ci flight_cost, of the flight layer
"""
