"""The most instructions of a call: the heaviest flow through the graphs of a function and its callees.

Each function is a linear program: the flow into a block equals the flow out of it, loops turn as often as the table of
bounds allows, and a call costs what the called function does. A function named in a statement of the table becomes
a part of its caller's program, so the statement can relate different functions; any other is solved once separately,
for each set of lines by which the table distinguishes its callers.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import product

from bench.running import LedgerError

from .loop_bounds import Row, counted, value_of
from .loops import Loop, loops_of
from .machine_code import Block, Function, Instruction
from .source_lines import Places, is_loop
from .whole_numbers import Program, Solution, solve

SIZED = ("memcpy", "memset")  # their third argument bounds their loops
SIZE_REGISTER = "r2"


@dataclass(frozen=True)
class Context:
    """The properties by which the table distinguishes callers: the texts of passed lines of the table, and the size
    argument."""

    passed: frozenset[str] = frozenset()
    size: int | None = None
    exact: bool = True  # ... or only bounded by it


@dataclass
class Code:
    """The image's code, its places and the table."""

    functions: dict[int, Function]
    places: Mapping[int, Places]
    table: Sequence[Row]
    constants: Mapping[str, int]
    used: set[int] = field(default_factory=set)  # numbers of the table's lines that were used

    def __post_init__(self) -> None:
        self.texts = sorted({text for row in self.table for text in row.passes})
        self.loops = {start: loops_of(function) for start, function in self.functions.items()}
        self.lines = {start: lines_of_loops(self, function) for start, function in self.functions.items()}

    def at(self, instruction: Instruction) -> Places:
        return self.places.get(instruction.address, ())

    def bound(self, row: Row, context: Context | None = None) -> int:
        """``size``, and its remainders by multiples of 4, 16 and 64; any remainder if the size is only bounded."""
        self.used.add(row.number)
        names = dict(self.constants)
        if context and context.size is not None:
            size, exact = context.size, context.exact
            names |= {"size": size, **{f"over{n}": size % n if exact else n - 1 for n in (4, 16, 64)}}
        return value_of(row.most, names)


# ----------------------------------------------------------------------------------------------------------- loops --


def bare(name: str) -> str:
    """The name of the source's function: compilers add suffixes to modified copies."""
    return name.split(".")[0]


def lines_in(code: Code, function: Function, loop: Loop) -> set[tuple[str, str]]:
    """(function, line) of the loop lines behind a loop's own blocks, without those of loops inside it."""
    inner = [other for other in code.loops[function.start] if other.outer is loop]
    own = loop.blocks.difference(*(other.blocks for other in inner))
    places = (p for at in own for i in function.blocks[at].instructions for p in code.at(i))
    return {(bare(place.function), place.text) for place in places if is_loop(place.text)}


def lines_of_loops(code: Code, function: Function) -> dict[int, set[tuple[str, str]]]:
    """The line of each loop, by its header. The test of an inner loop before its first turn is in the outer one:
    if a loop has only one line, those around it and inside it have another."""
    loops = code.loops[function.start]
    found = {loop.header: lines_in(code, function, loop) for loop in loops}
    changed = True
    while changed:
        changed = False
        for loop in (loop for loop in loops if len(found[loop.header]) == 1):
            for other in loops:
                nested = other.header in loop.blocks or loop.header in other.blocks
                if other is not loop and nested and len(found[other.header]) > 1:
                    changed |= bool(found[other.header] & found[loop.header])
                    found[other.header] -= found[loop.header]
    return found


def names_of(code: Code, function: Function, loop: Loop) -> set[tuple[str, str]]:
    """(function, line) by which the table may name a loop."""
    number = 1 + code.loops[function.start].index(loop)
    return code.lines[function.start][loop.header] | {(bare(function.name), f"#{number}")}


def table_rows_of(code: Code, function: Function, loop: Loop) -> list[Row]:
    """The table's rows for a loop, by its number rather than its line; otherwise the bound in its line."""
    names = names_of(code, function, loop)
    found = [row for row in code.table if row.kind == "loop" and (row.function, row.line) in names]
    numbered = [row for row in found if row.line.startswith("#")]
    if numbered or any(not row.when for row in found):
        return numbered or found
    lines = sorted(names - {(bare(function.name), line) for _, line in names if line.startswith("#")})
    most = counted(lines[0][1], code.constants) if len(lines) == 1 else None
    if most is not None:
        found.append(Row(0, "loop", *lines[0], "", str(most), "entry", "from its line"))
    return found


def rows_of(code: Code, function: Function, loop: Loop, context: Context) -> list[Row]:
    """The rows that bound a loop; a row for the specific caller takes precedence."""
    passed = context.passed | inlined_by(code, function, loop)
    found = [row for row in table_rows_of(code, function, loop) if set(row.passes) <= passed]
    most = max((len(row.passes) for row in found), default=0)
    return [row for row in found if len(row.passes) == most]


def inlined_by(code: Code, function: Function, loop: Loop) -> set[str]:
    """Texts of lines by which the loop's function was inlined into this one, if it was."""
    owners = {name for name, line in code.lines[function.start][loop.header] if not line.startswith("#")}
    ways: Counter[Places] = Counter()
    for address in loop.blocks:
        for places in map(code.at, function.blocks[address].instructions):
            depth = next((i for i, place in enumerate(places) if bare(place.function) in owners), None)
            if depth is not None:
                ways[places[depth + 1 :]] += 1
    around = ways.most_common(1)[0][0] if ways else ()
    return {text for text in code.texts if any(text in place.text for place in around)}


def is_tested_at_its_end(code: Code, function: Function, loop: Loop, row: Row) -> bool:
    """Whether each run of the header is a turn: nothing of the loop's line leaves it before the turn is
    complete."""
    if not loop.has_one_way_in:
        return False
    last = {at for at, _ in loop.backs}
    for address in loop.exits(function):
        tests = {p.text for i in function.blocks[address].instructions for p in code.at(i)}
        if address not in last and (row.line.startswith("#") or row.line in tests):
            return False
    return True


# ------------------------------------------------------------------------------------------------ a linear program --


@dataclass
class Instance:
    """A function within a program: its variables."""

    function: Function
    context: Context
    edges: dict[tuple[int, int], int]  # of flows, by the two blocks
    enters: int
    calls: dict[Pair, list[dict[int, int]]] = field(default_factory=dict)  # runs of the calls named in statements
    parts: dict[Pair, list[dict[int, int]]] = field(
        default_factory=dict
    )  # ... of the blocks inlined in place of a call


def runs_of(instance: Instance, address: int) -> dict[int, int]:
    """Number of runs of a block: the sum of the flows into it."""
    row = {variable: 1 for (_, to), variable in instance.edges.items() if to == address}
    if address == instance.function.start:
        row[instance.enters] = row.get(instance.enters, 0) + 1
    return row


def sum_of(*parts: tuple[int, Mapping[int, int]]) -> dict[int, int]:
    total: Counter[int] = Counter()
    for factor, row in parts:
        for variable, value in row.items():
            total[variable] += factor * value
    return {variable: value for variable, value in total.items() if value}


def flows(instance: Instance, edges: Sequence[tuple[int, int]]) -> dict[int, int]:
    return {instance.edges[edge]: 1 for edge in edges}


def entries_of(instance: Instance, loop: Loop) -> dict[int, int]:
    row = flows(instance, loop.entries)
    if instance.function.start in loop.blocks:
        row[instance.enters] = 1
    return row


Pair = tuple[str, str]  # caller and callee: any caller, one including inlined copies, or "=" the function alone
ANY = "any"


def terms_of(statement: Row) -> list[tuple[int, Pair]]:
    """The terms of a statement: multiples of the runs of a call."""
    terms = []
    for part in statement.line.split("|"):
        found = re.fullmatch(r"\s*(?:(-?\d+) )?(=?\w+) > (\w+)\s*", part)
        if not found:
            raise LedgerError(f"line {statement.number} of the table: {part}: not <times> <caller> > <callee>")
        terms.append((int(found.group(1) or 1), (found.group(2), found.group(3))))
    return terms


def applies_to(statement: Row, public: str) -> bool:
    return statement.function == "all" or public in statement.function.split("; ")


@dataclass
class Finder:
    """Finds longest paths. ``public``: the public call, which selects statements of the table."""

    code: Code
    public: str

    def __post_init__(self) -> None:
        own = [row for row in self.code.table if row.kind in ("most", "case") and applies_to(row, self.public)]
        self.statements = [row for row in own if row.kind == "most"]
        self.cases = [row for row in own if row.kind == "case"]
        self.pairs = {pair for row in own for _, pair in terms_of(row)}
        self.pairs |= {(ANY, row.per[2:]) for row in self.code.table if row.per.startswith("> ")}
        self.known: dict[tuple[int, Context], tuple[int, Counter[str]]] = {}
        self.in_statement = lru_cache(maxsize=None)(self._in_statement)
        self.relevant = lru_cache(maxsize=None)(self._relevant)

    # ------------------------------------------------------------------------------------------------------- calls

    def pair_of(self, function: Function, instruction: Instruction, callee: int) -> set[tuple[str, str]]:
        """The pairs that name a call: any function whose code contains the instruction, and the callee."""
        frames = [bare(place.function) for place in self.code.at(instruction)] or [bare(function.name)]
        names = {*frames, bare(function.name), ANY, f"={frames[0]}"}
        return {(name, bare(self.code.functions[callee].name)) for name in names} & self.pairs

    def inlined_in(self, block: Block) -> set[Pair]:
        """The pairs with code inlined in a block."""
        found: set[Pair] = set()
        for instruction in block.instructions:
            names = [bare(place.function) for place in self.code.at(instruction)]
            found |= {pair for callee, caller in zip(names, names[1:]) for pair in ((caller, callee), (ANY, callee))}
        return found & self.pairs

    def turns_within(self, function: Function, block: Block, pair: Pair) -> bool:
        """Whether a block is in a loop of an inlined function: it then runs more often than the function was called."""
        around = (loop for loop in self.code.loops[function.start] if block.start in loop.blocks)
        return any(pair in self.inlined_in(function.blocks[loop.header]) for loop in around)

    def _in_statement(self, start: int) -> bool:
        """Whether a statement names a call in this function or below, or a bound of a public call as a whole."""
        function = self.code.functions[start]
        rows = (row for loop in self.code.loops[start] for row in table_rows_of(self.code, function, loop))
        return any(row.per == "all" or row.per.startswith("> ") for row in rows) or any(
            self.inlined_in(block)
            or any(self.pair_of(function, i, to) or self.in_statement(to) for i, to in block.calls)
            for block in function.blocks.values()
        )

    def _relevant(self, start: int) -> frozenset[str]:
        """Texts of the table that affect the loops of this function or below."""
        function = self.code.functions[start]
        names = set().union(*(names_of(self.code, function, loop) for loop in self.code.loops[start]), set())
        rows = (row for row in self.code.table if row.kind == "loop" and (row.function, row.line) in names)
        own = {text for row in rows for text in row.passes}
        below = (self.relevant(to) for block in function.blocks.values() for _, to in block.calls)
        return frozenset(own.union(*below))

    def context_of(self, function: Function, context: Context, block: Block, call: Instruction, to: int) -> Context:
        lines = {place.text for place in self.code.at(call)}
        passed = {text for text in self.code.texts if any(text in line for line in lines)} | context.passed
        size, exact = None, True
        if self.code.functions[to].name in SIZED:
            size, exact = self.size_at(function, block, call, to, lines)
        return Context(frozenset(passed) & self.relevant(to), size, exact)

    def size_at(
        self, function: Function, block: Block, call: Instruction, to: int, lines: set[str]
    ) -> tuple[int, bool]:
        """The size argument, exactly: a constant of the code; or its bound in the table."""
        name = self.code.functions[to].name
        found = constant_before(function, block, call)
        if found is not None:
            return found, True
        for row in self.code.table:
            if row.kind == "size" and row.function == name and any(row.line in line for line in lines):
                return self.code.bound(row), False
        raise LedgerError(
            f"{function.name}: {name} of an unknown size at {call.address:x}: {' / '.join(sorted(lines))}"
        )

    # ------------------------------------------------------------------------------------------------------ programs

    def most(self, start: int, context: Context) -> tuple[int, Counter[str]]:
        """Instructions of a function and its callees; and by function on one longest path."""
        key = (start, context)
        if key not in self.known:
            program = Program()
            one = program.variable()
            parts: list[tuple[Instance, Block, Counter[str]]] = []
            instances: list[Instance] = []
            self.add(program, start, context, {one: 1}, parts, instances)
            for instance in instances:
                self.add_loops(program, instance, instances)
            self.add_statements(program, instances)
            solution = self.worst_case_of(program, instances)
            shares: Counter[str] = Counter()
            for instance, block, costs in parts:
                runs = sum(solution.values[v] * n for v, n in runs_of(instance, block.start).items())
                for name, cost in costs.items():
                    shares[name] += round(runs * cost)
            self.known[key] = (solution.most, shares)
        return self.known[key]

    def worst_case_of(self, program: Program, instances: Sequence[Instance]) -> Solution:
        """The most over all cases of the table: for each case line, one of its calls runs once, or none
        does."""
        choices = [self.choices_of(row, instances) for row in self.cases]
        best: Solution | None = None
        for case in product(*choices):
            fixed = Program(program.cost, program.equal + [row for rows in case for row in rows], program.at_most)
            solution = solve(fixed)
            if solution and (best is None or solution.most > best.most):
                best = solution
        if best is None:
            raise LedgerError(f"{self.public}: the table excludes every path")
        return best

    def choices_of(self, row: Row, instances: Sequence[Instance]) -> list[list[dict[int, int]]]:
        """The equations of each case."""
        self.code.used.add(row.number)
        totals = []
        for _, pair in terms_of(row):
            runs = [(1, r) for instance in instances for r in instance.calls.get(pair, [])]
            totals += [sum_of(*runs)] if runs else []
        if not totals:
            return [[]]
        chosen = [[sum_of((1, t), (-(i == at), {0: 1})) for i, t in enumerate(totals)] for at in range(len(totals))]
        return [totals, *chosen]

    def add(
        self,
        program: Program,
        start: int,
        context: Context,
        enters: Mapping[int, int],
        parts: list[tuple[Instance, Block, Counter[str]]],
        instances: list[Instance],
    ) -> None:
        """Adds a function to a program; `enters` is the number of its calls."""
        function = self.code.functions[start]
        instance = Instance(function, context, {}, program.variable())
        instances.append(instance)
        program.equal.append(sum_of((1, {instance.enters: 1}), (-1, enters)))
        costs = {b: Counter({function.name: len(block.instructions)}) for b, block in function.blocks.items()}
        for address, block in function.blocks.items():
            for call, to in block.calls:
                if not self.in_statement(to):
                    below = self.context_of(function, context, block, call, to)
                    costs[address].update(self.most(to, below)[1] | Counter())
                    surplus = self.most(to, below)[0] - sum(self.most(to, below)[1].values())
                    costs[address]["(rounding)"] += surplus
        leaves = {b: program.variable() for b, block in function.blocks.items() if block.leaves}
        for address, block in function.blocks.items():
            for to in block.followers:
                instance.edges[(address, to)] = program.variable()
        for address, block in function.blocks.items():
            into = runs_of(instance, address)
            out = {instance.edges[(address, to)]: 1 for to in block.followers}
            if address in leaves:
                out[leaves[address]] = 1
            program.equal.append(sum_of((1, into), (-1, out)))
            for variable in out:
                program.cost[variable] += sum(costs[address].values())
            parts.append((instance, block, costs[address]))
            for pair in self.inlined_in(block):
                if not self.turns_within(function, block, pair):
                    instance.parts.setdefault(pair, []).append(into)
            for call, to in block.calls:
                for pair in self.pair_of(function, call, to):
                    instance.calls.setdefault(pair, []).append(into)
                if self.in_statement(to):
                    below = self.context_of(function, context, block, call, to)
                    self.add(program, to, below, into, parts, instances)

    def add_loops(self, program: Program, instance: Instance, instances: Sequence[Instance]) -> None:
        """A bound of all turns together applies to all loops that the compiler made from the source's loop."""
        function, context = instance.function, instance.context
        totals: dict[tuple[Row, tuple[tuple[int, int], ...]], list[tuple[int, dict[int, int]]]] = {}
        for loop in self.code.loops[function.start]:
            rows = rows_of(self.code, function, loop, context)
            if not rows:
                names = " or ".join(f"{name}: {line}" for name, line in sorted(names_of(self.code, function, loop)))
                raise LedgerError(f"{function.name}: a loop at {loop.header:x} without a bound: {names}")
            backs = flows(instance, loop.backs)
            for row in rows:
                once = is_tested_at_its_end(self.code, function, loop, row)
                turns = sum_of((1, backs), (1, entries_of(instance, loop) if once else {}))
                scope = self.scope_of(instance, loop, row, instances)
                if row.per == "entry":
                    program.at_most.append(sum_of((1, turns), (-self.code.bound(row, context), scope)))
                else:
                    totals.setdefault((row, tuple(sorted(scope.items()))), []).append((1, turns))
        for (row, scope_items), parts in totals.items():
            program.at_most.append(sum_of(*parts, (-self.code.bound(row, context), dict(scope_items))))

    def scope_of(self, instance: Instance, loop: Loop, row: Row, instances: Sequence[Instance]) -> dict[int, int]:
        if row.per == "entry":
            return entries_of(instance, loop)
        if row.per == "all":
            return {0: 1}
        if row.per.startswith("> "):
            return sum_of(*((1, runs) for other in instances for runs in other.calls.get((ANY, row.per[2:]), [])))
        if row.per == "call":
            return {instance.enters: 1}
        outer = loop.outer
        if row.per == "outer2" and outer:
            outer = outer.outer
        if not outer:
            raise LedgerError(f"{instance.function.name}: line {row.number} of the table: no loop around this one")
        return entries_of(instance, outer)

    def add_statements(self, program: Program, instances: Sequence[Instance]) -> None:
        """Each block inlined in place of a call is compared with the rest, as if it ran alone."""
        for row in self.statements:
            calls: list[tuple[int, dict[int, int]]] = []
            placed: list[list[tuple[int, dict[int, int]]]] = []
            for times, pair in terms_of(row):
                calls += [(times, runs) for instance in instances for runs in instance.calls.get(pair, [])]
                blocks = [(times, runs) for instance in instances for runs in instance.parts.get(pair, [])]
                placed += [blocks] if blocks else []
                if blocks and (len(placed) > 1 or times < 0):
                    raise LedgerError(f"line {row.number} of the table: {pair[1]} was inlined in place of its call")
            if calls or placed:
                most = self.code.bound(row)
                for part in placed[0] if placed else [(0, {})]:
                    program.at_most.append(sum_of((-most, {0: 1}), part, *calls))


SETS_CONSTANT = ("mov", "movs", "mov.w", "movw", "mov.n")
READS_FIRST = ("str", "cmp", "cmn", "tst", "teq", "vstr", "stm", "vstm", "push", "cb")
WRITES_TWO = ("ldrd", "umull", "smull", "umlal", "smlal", "vmov")


def sets_size(instruction: Instruction) -> bool:
    """Whether an instruction may change the size register."""
    if instruction.name.startswith(READS_FIRST):
        return False
    words = re.findall(r"\w+", instruction.operands)
    if instruction.name.startswith(("ldm", "pop")):
        return SIZE_REGISTER in words[1:] or words[:1] == [SIZE_REGISTER]
    return SIZE_REGISTER in words[: 2 if instruction.name.startswith(WRITES_TWO) else 1]


def constant_before(function: Function, block: Block, call: Instruction) -> int | None:
    """Value of the size register at a call, if the instructions before determine it."""
    visited: set[int] = set()
    at = block.instructions.index(call)
    while True:
        for instruction in reversed(block.instructions[:at]):
            if any(instruction is other for other, _ in block.calls):
                return None
            if sets_size(instruction):
                constant = instruction.operands.rpartition("#")[2]
                known = instruction.name in SETS_CONSTANT and constant.isdigit()
                return int(constant) if known else None
        before = function.before(block.start)
        visited.add(block.start)
        if len(before) != 1 or before[0].start in visited or block.start == function.start:
            return None
        block = before[0]
        at = len(block.instructions)
