"""Functions of an ARM image as graphs of basic blocks, from the output of objdump.

Every instruction that may end a block is either known or refused: a branch through a register that is no return, a jump
into the middle of another function, an instruction that writes the program counter in another way.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from bench.running import LedgerError

CONDITION = "eq|ne|cs|hs|cc|lo|mi|pl|vs|vc|hi|ls|ge|lt|gt|le"
BRANCH = re.compile(rf"b({CONDITION})?(?:\.[wn])?$")
COMPARE_BRANCH = re.compile(r"cbn?z$")
CALL = re.compile(rf"blx?({CONDITION})?(?:\.[wn])?$")
LEAVE = re.compile(rf"bx({CONDITION})?$")
TAKE = re.compile(rf"(?:pop|ldm(?:ia|db)?|ldr)({CONDITION})?(?:\.w)?$")  # ... into pc: a return
TABLE = re.compile(r"tb[bh]$")
IF_THEN = re.compile(r"it[te]*$")
TARGET = re.compile(r"\b([0-9a-f]+) <")
WRITES_PC = re.compile(r"^pc\b|\{[^}]*\bpc\}")
STORES = ("str", "stm", "push", "cmp", "tst", "cmn", "teq", "vstr", "vstm", "vpush")
NO_OPERATION = ("b", "udf", "bkpt")


@dataclass(frozen=True)
class Instruction:
    address: int
    name: str
    operands: str

    @property
    def target(self) -> int | None:
        found = TARGET.search(self.operands)
        return int(found.group(1), 16) if found else None


@dataclass
class Block:
    """Instructions that run together; those that a condition skips count as run."""

    instructions: list[Instruction]
    followers: list[int] = field(default_factory=list)  # addresses of blocks of the same function
    leaves: bool = False  # may return here, or jump to another function
    calls: list[tuple[Instruction, int]] = field(default_factory=list)  # including jumps to other functions

    @property
    def start(self) -> int:
        return self.instructions[0].address

    @property
    def last(self) -> Instruction:
        return self.instructions[-1]


@dataclass
class Function:
    name: str
    start: int
    blocks: dict[int, Block]  # by address

    def before(self, address: int) -> list[Block]:
        return [block for block in self.blocks.values() if address in block.followers]


@dataclass
class Listing:
    """A function in objdump's output: instructions, and data between them by address."""

    name: str
    start: int
    instructions: list[Instruction] = field(default_factory=list)
    data: dict[int, bytes] = field(default_factory=dict)


DATA_BYTES = {".byte": 1, ".short": 2, ".word": 4}


def listings(text: str) -> list[Listing]:
    """Parses the output of ``objdump -d --no-show-raw-insn``."""
    found: list[Listing] = []
    for line in text.splitlines():
        header = re.match(r"^([0-9a-f]+) <([^>]+)>:$", line)
        if header:
            found.append(Listing(header.group(2), int(header.group(1), 16)))
            continue
        row = re.match(r"^\s*([0-9a-f]+):\t(\S+)(?:\t(.*))?$", line)
        if not row or not found:
            continue
        address, name = int(row.group(1), 16), row.group(2)
        operands = re.split(r"\t?@ ", row.group(3) or "")[0].strip()
        if name in DATA_BYTES:
            value = int(operands.split()[0], 16)
            found[-1].data[address] = value.to_bytes(DATA_BYTES[name], "little")
        else:
            found[-1].instructions.append(Instruction(address, name, operands))
    return found


def table_targets(listing: Listing, instruction: Instruction) -> list[int]:
    """Targets of a jump through a table of offsets: every entry of the data that follows it."""
    width = 1 if instruction.name == "tbb" else 2
    base = instruction.address + 4
    stored, at = b"", base
    while at in listing.data:
        stored += listing.data[at]
        at += len(listing.data[at])
    entries = [int.from_bytes(stored[i : i + width], "little") for i in range(0, len(stored) - width + 1, width)]
    known = {i.address for i in listing.instructions}
    targets = [base + 2 * entry for entry in entries if base + 2 * entry in known]
    if not targets:
        raise LedgerError(f"{listing.name}: an unreadable jump table at {instruction.address:x}")
    return targets


@dataclass(frozen=True)
class Flow:
    """Effect of an instruction on the control flow."""

    targets: tuple[int, ...] = ()
    falls: bool = True  # the next instruction may follow
    leaves: bool = False
    call: int | None = None

    @property
    def ends(self) -> bool:
        return bool(self.targets) or not self.falls or self.leaves


def flow_of(listing: Listing, instruction: Instruction) -> Flow:
    name, operands = instruction.name, instruction.operands
    branch = BRANCH.match(name)
    if branch or COMPARE_BRANCH.match(name):
        if instruction.target is None:
            raise LedgerError(f"{listing.name}: {name} {operands} leads nowhere")
        return Flow(targets=(instruction.target,), falls=not branch or branch.group(1) is not None)
    if CALL.match(name):
        if instruction.target is None:
            raise LedgerError(f"{listing.name}: an indirect call at {instruction.address:x}")
        return Flow(call=instruction.target)
    leave = LEAVE.match(name)
    if leave:
        if operands != "lr":
            raise LedgerError(f"{listing.name}: a jump through {operands} at {instruction.address:x}")
        return Flow(falls=leave.group(1) is not None, leaves=True)
    if TABLE.match(name):
        return Flow(targets=tuple(table_targets(listing, instruction)), falls=False)
    if not name.startswith(STORES) and WRITES_PC.search(operands):
        take = TAKE.match(name)
        if not take:
            raise LedgerError(f"{listing.name}: {name} {operands} writes the program counter")
        return Flow(falls=take.group(1) is not None, leaves=True)
    return Flow()


def function_of(listing: Listing, starts: set[int]) -> Function:
    """The graph of one function. A jump to the start of another function is a call followed by a return."""
    inside = {instruction.address for instruction in listing.instructions}
    flows = {i.address: flow_of(listing, i) for i in listing.instructions}
    leaders = {listing.start}
    for this, after in zip(listing.instructions, [*listing.instructions[1:], None]):
        flow = flows[this.address]
        leaders |= {target for target in flow.targets if target in inside}
        if flow.ends and after:
            leaders.add(after.address)
    function = Function(listing.name, listing.start, {})
    block: Block | None = None
    for this, after in zip(listing.instructions, [*listing.instructions[1:], None]):
        if this.address in leaders or block is None:
            block = Block([])
            function.blocks[this.address] = block
        block.instructions.append(this)
        flow = flows[this.address]
        if flow.call is not None:
            block.calls.append((this, flow.call))
        for target in flow.targets:
            if target in inside:
                block.followers.append(target)
            elif target in starts:
                block.calls.append((this, target))
                block.leaves = True
            else:
                raise LedgerError(f"{listing.name}: a jump to {target:x}, which is no function's start")
        block.leaves |= flow.leaves
        if flow.ends or (after and after.address in leaders):
            if flow.falls and after:
                block.followers.append(after.address)
            block = None
    return reachable(function)


def reachable(function: Function) -> Function:
    """Drops unreachable blocks, such as padding; a block that falls off the end is an error."""
    visited: set[int] = set()
    rest = [function.start]
    while rest:
        address = rest.pop()
        if address not in visited:
            visited.add(address)
            rest += function.blocks[address].followers
    blocks = {address: block for address, block in function.blocks.items() if address in visited}
    for block in blocks.values():
        block.followers = list(dict.fromkeys(block.followers))
        if not block.followers and not block.leaves:
            raise LedgerError(f"{function.name}: nothing follows {block.last.address:x} {block.last.name}")
    return Function(function.name, function.start, blocks)


def functions_below(text: str, roots: Iterable[str]) -> dict[int, Function]:
    """The functions with these names and all their callees, by address."""
    found = {listing.start: listing for listing in listings(text)}
    starts = set(found)
    names: dict[str, list[int]] = {}
    for start, listing in found.items():
        names.setdefault(listing.name, []).append(start)
    rest: list[int] = []
    for root in roots:
        if len(names.get(root, [])) != 1:
            raise LedgerError(f"{root}: {len(names.get(root, []))} functions of that name")
        rest += names[root]
    result: dict[int, Function] = {}
    while rest:
        start = rest.pop()
        if start in result:
            continue
        if start not in found:
            raise LedgerError(f"a call of {start:x}, which is not the start of a function")
        result[start] = function_of(found[start], starts)
        rest += [to for block in result[start].blocks.values() for _, to in block.calls]
    return result
