"""Loops of a function and their nesting: strongly connected parts of its graph, and recursively of these parts without
the edges back to their headers.

A loop mostly has one entry, its header. If a compiler made a second one into its middle, that is an entry
like any other: runs are counted by the edges back to the header, and every turn takes one of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from .machine_code import Function

Edge = tuple[int, int]


@dataclass
class Loop:
    """Blocks that run repeatedly."""

    header: int
    blocks: set[int]
    backs: list[Edge]  # from inside to the header
    entries: list[Edge]  # from outside; the start of the function is not an edge
    outer: Loop | None  # the smallest loop that contains it

    @property
    def has_one_way_in(self) -> bool:
        return all(to == self.header for _, to in self.entries)

    def exits(self, function: Function) -> list[int]:
        """Blocks of the loop after which it may end."""
        blocks = function.blocks
        return sorted(b for b in self.blocks if blocks[b].leaves or set(blocks[b].followers) - self.blocks)


def order_of(function: Function) -> list[int]:
    """Blocks in reverse postorder."""
    done: list[int] = []
    visited = {function.start}
    stack = [(function.start, iter(function.blocks[function.start].followers))]
    while stack:
        address, followers = stack[-1]
        for follower in followers:
            if follower not in visited:
                visited.add(follower)
                stack.append((follower, iter(function.blocks[follower].followers)))
                break
        else:
            done.append(address)
            stack.pop()
    return done[::-1]


def connected(nodes: set[int], followers: dict[int, list[int]]) -> Iterator[set[int]]:
    """The strongly connected parts with a cycle in the graph restricted to these nodes."""
    number: dict[int, int] = {}
    low: dict[int, int] = {}
    open_: list[int] = []
    held: set[int] = set()

    for root in sorted(nodes):
        if root in number:
            continue
        stack = [(root, iter(followers[root]))]
        number[root] = low[root] = len(number)
        open_.append(root)
        held.add(root)
        while stack:
            node, rest = stack[-1]
            for to in rest:
                if to not in number:
                    number[to] = low[to] = len(number)
                    open_.append(to)
                    held.add(to)
                    stack.append((to, iter(followers[to])))
                    break
                if to in held:
                    low[node] = min(low[node], number[to])
            else:
                stack.pop()
                if stack:
                    low[stack[-1][0]] = min(low[stack[-1][0]], low[node])
                if low[node] == number[node]:
                    part = set()
                    while not part or node not in part:
                        part.add(open_.pop())
                    held -= part
                    if len(part) > 1 or node in followers[node]:
                        yield part


def loops_of(function: Function) -> list[Loop]:
    """By address of the header."""
    place = {address: i for i, address in enumerate(order_of(function))}
    edges = [(block.start, to) for block in function.blocks.values() for to in block.followers]
    found: list[Loop] = []

    def search(nodes: set[int], closed: set[int], outer: Loop | None) -> None:
        followers = {n: [t for t in function.blocks[n].followers if t in nodes and t not in closed] for n in nodes}
        for part in connected(nodes, followers):
            entries = [edge for edge in edges if edge[1] in part and edge[0] not in part]
            ways_in = {to for _, to in entries} | ({function.start} & part)
            header = min(ways_in or part, key=place.__getitem__)
            backs = [(at, to) for at, to in edges if to == header and at in part]
            loop = Loop(header, part, backs, entries, outer)
            found.append(loop)
            search(part, closed | {header}, loop)

    search(set(function.blocks), set(), None)
    return sorted(found, key=lambda loop: loop.header)
