"""Faults: each hits a running project once, and may have to be undone before the next run."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from dataclasses import dataclass

from tests.studio.night.torture.cluster.hostile import KINDS
from tests.studio.night.torture.cluster.studies import scheduler_killed, study_again
from tests.studio.night.torture.damage import cut, flipped, gone, no_text
from tests.studio.night.torture.fetching import fetch_again, fetch_killed
from tests.studio.night.torture.following import live_page_hit, wrong_pages
from tests.studio.night.torture.hits import (
    Hit,
    asked_to_stop,
    clock_set_back,
    damaged,
    film,
    folder_for_lock,
    full_disk,
    limited,
    pictures,
    read_only,
    records,
    results,
    room_again,
    second_run,
    signal_to,
    stop_for_a_while,
    swapped,
    writable,
)
from tests.studio.night.torture.project import COORDINATOR, Project
from tests.studio.night.torture.stage import MODULE
from tests.studio.night.torture.workers import (
    Workers,
    admitted,
    disk_of_one,
    expelled,
    healed,
    is_there,
    limit_one,
    no_scheduler,
    scheduler_again,
    signal_to_one,
)


@dataclass(frozen=True)
class Fault:
    """One kind of fault."""

    name: str
    hit: Hit
    undo: Callable[[Project], object] | None = None
    """Remedy of a user before the next run."""
    hits_film: bool = False
    """True if it may damage the film itself."""
    during: str = ""
    """A word in the arguments of the process during which it hits; anywhere in the run if empty."""
    target: str = ""
    """The target of make that it needs; any that makes films if empty."""
    cluster: bool = False
    """True if the workers of a cluster render the pictures."""
    before: Callable[[Project], object] | None = None
    """Preparation before the run."""
    ends_well: bool = False
    """True if the run succeeds in spite of it."""
    destroys: int = 0
    """Pictures that it may destroy, each of which is then rendered once more."""
    follow: Callable[[Project], int] | None = None
    """Trial after the run; it returns the number of wrong files."""


STAGE, FILM, BLENDER = MODULE, f"{MODULE} film", "render.blender.worker.worker"
MAKE, TMUX = "make -o install run-all", "tmux -L night"
TERM, INT, HUP, KILL = signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL
STOP, SEGV = signal.SIGSTOP, signal.SIGSEGV
MAKE_TELLS = [INT, HUP] if sys.platform == "linux" else []
"""Signals that make keeps to itself; only Linux shows that it got them."""
FAULTS = [
    *(
        Fault(f"{what.name} to make", signal_to("make", what), during=FILM, target="run-all")
        for what in (TERM, KILL, *MAKE_TELLS)
    ),
    *(Fault(f"{what.name} to the coordinator", signal_to(COORDINATOR, what)) for what in (TERM, INT, HUP, KILL)),
    *(Fault(f"{what.name} to a stage", signal_to(STAGE, what), during=STAGE) for what in (TERM, INT, KILL)),
    *(Fault(f"{what.name} to Blender", signal_to(BLENDER, what), during=BLENDER) for what in (TERM, KILL, SEGV)),
    Fault("Blender stopped", signal_to(BLENDER, STOP), during=BLENDER),
    Fault("a stage stopped for a while", stop_for_a_while, during=FILM),
    Fault("SIGKILL to ffmpeg", signal_to("ffmpeg", KILL), during="ffmpeg"),
    Fault("a read-only disk", read_only, undo=writable, during=MAKE, target="run-all"),
    Fault("make stop", asked_to_stop),
    Fault("a clock that was set back", clock_set_back),
    Fault("a folder in place of a lock", folder_for_lock),
    Fault("two runs at once", second_run),
    Fault("processes of a live page hit while it follows", live_page_hit, follow=wrong_pages),
    Fault("a picture cut", damaged(pictures, cut), destroys=1),
    Fault("a picture with a flipped byte", damaged(pictures, flipped), destroys=1),
    Fault("a picture deleted", damaged(pictures, gone), destroys=1),
    Fault("two pictures swapped", swapped, destroys=2),
    Fault("no text in a stamp, timing.json or frames.json", damaged(records, no_text)),
    Fault("a stamp, timing.json or frames.json cut", damaged(records, cut)),
    Fault("no text in data.json, parts.json or a solid", damaged(results, no_text)),
    Fault("a result or stamp with a flipped byte", damaged(results, flipped)),
    Fault("the film cut", damaged(film, cut), hits_film=True),
    Fault("the film with a flipped byte", damaged(film, flipped), hits_film=True),
]
if sys.platform == "linux":
    FAULTS += [
        Fault("no room for Blender's files", limited(BLENDER, "files"), during=BLENDER),
        Fault("no room for a stage's files", limited(STAGE, "files"), during=STAGE),
        Fault("no memory for Blender", limited(BLENDER, "memory"), during=BLENDER),
        Fault("no memory for a stage", limited(STAGE, "memory"), during=STAGE),
    ]
BACKGROUND = [Fault("SIGKILL to tmux", signal_to(TMUX, KILL), during=STAGE, target="overnight")]
"""Only where there is tmux."""
FETCH = [Fault("films fetched meanwhile, killed and fetched again", fetch_killed, follow=fetch_again)]
"""Only where there are rsync, ssh and sshd."""
CLUSTER = [
    *(
        Fault(f"{what.name} to {whom}", signal_to_one(pick, what), undo=healed, during=FILM, cluster=True)
        for whom, pick in (("a worker", Workers.workers), ("a worker's Blender", Workers.blenders))
        for what in (KILL, STOP)
    ),
    Fault("no room for a worker's files", limit_one(Workers.workers, "files"), undo=healed, during=FILM, cluster=True),
    *(
        Fault(
            f"no {what} for a worker's Blender",
            limit_one(Workers.blenders, kind),
            undo=healed,
            during=FILM,
            cluster=True,
        )
        for what, kind in (("room for the files", "files"), ("memory", "memory"))
    ),
    Fault("SIGKILL to the scheduler", no_scheduler, undo=scheduler_again, during=FILM, cluster=True),
    Fault(
        "SIGKILL to the scheduler during a study",
        scheduler_killed,
        undo=scheduler_again,
        during=FILM,
        cluster=True,
        follow=study_again,
    ),
    *(
        Fault(
            f"a worker that sends {kind}",
            is_there,
            before=admitted(kind),
            undo=expelled,
            during=FILM,
            cluster=True,
            ends_well=True,
        )
        for kind in KINDS
    ),
]
"""Only where there are a scheduler and workers, on Linux."""
DISK_OF_ONE = [Fault("a full disk of a worker", disk_of_one, undo=healed, during=FILM, cluster=True)]
"""Only where one of the workers has a small disk of its own."""
FULL = [
    *[Fault("a full disk", full_disk, undo=room_again)] * 2,
    *[Fault("a disk that gets full under Blender", full_disk, undo=room_again, during=BLENDER)] * 3,
]
"""Only where a small disk could be mounted; more likely than each of the others."""
