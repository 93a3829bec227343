"""Terms of a deal: the work, its size a worker, the times after which a worker is given up, the words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, NamedTuple

from mbsd.dealing.report import Key


class Kind(NamedTuple):
    """One kind of work, as a worker does it and as its answer is read by who ordered it."""

    task: Callable[..., bytes]
    """Does a group: called with ``given``, the orders as keys and what to do, and the contents sent along; gives a
    Report as bytes.
    """
    given: tuple[Any, ...]
    read: Callable[[Any, bytes], Any]
    """The result of the order with this key from the bytes that came. Raises WrongAnswer if they are not one."""
    most: int
    """Bytes of the largest result that there can be."""
    note: Callable[[bytes], Any] = bytes
    """Reads what is said of the results of a group together. Raises WrongAnswer as well."""
    deadly: Callable[[Key], Any] | None = None
    """The result of an order that ends each worker; without it, workers that end say nothing of their orders."""
    needed: Mapping[str, Callable[[], bytes]] = MappingProxyType({})
    """Contents that a worker may ask for, by name."""
    salt: str = ""
    """Text that keeps all deals from beginning with the same worker."""


@dataclass(frozen=True)
class Manner:
    """Numbers by which work is dealt out. Times are in seconds."""

    target: float = 4.0
    """Time (s) that a group of orders should take."""
    largest: int = 64
    """Orders in a group."""
    ahead: int = 2
    """Groups that a worker has, so that it need not wait for the next."""
    patience: float = 300.0
    """Silence that is never too long of a worker whose pace is known."""
    unknown: float | None = None
    """The same of one whose pace is not; no other than that if None."""
    endless: bool = False
    """True if workers that are all silent may be so for ever."""
    times: float = 10.0
    """Multiple of what was expected: a worker that is silent for longer counts as stalled."""
    grace: float = 0.0
    """For so long no worker whose pace is unknown is helped by others that have nothing to do."""
    failures: int = 3
    """In a row, after which a worker is left out."""
    copies: int = 2
    """Workers that do the same order at most, when others have nothing to do."""
    threads: bool = False
    """True if a worker does as many groups at a time as it has threads."""
    first_alone: bool = False
    """True if others wait until the first order is done, which compiles what they load."""


class Voice(NamedTuple):
    """Words of one program.

    ``{where}`` is the scheduler's place, ``{shown}`` are workers and the reasons why they do nothing; other fields
    stand in these texts.
    """

    say: Callable[[str], None]
    warn: Callable[[str], None]
    error: Callable[[str], Exception]
    """The error of which a user can cure the cause."""
    duration: Callable[[float], str]
    no_scheduler: str
    gone: str
    silent: str
    """The scheduler has been so for too long."""
    nobody: str
    """No worker is left, and none comes."""
    without: str
    """No worker is there that can do it now."""
    one_comes: str
    """The event that the dealer then waits for, in words."""
    lied: str
    failed: str
    left_out: str
    """A worker failed for the last time."""
