"""Faults: each hits a running project once, and may have to be undone before the next run."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from dataclasses import dataclass

from tests.studio.night.torture import hits, workers
from tests.studio.night.torture.damage import cut, flipped, gone, no_text
from tests.studio.night.torture.fetching import fetch_again, fetch_killed
from tests.studio.night.torture.following import live_page_hit, wrong_pages
from tests.studio.night.torture.hostile import KINDS
from tests.studio.night.torture.project import COORDINATOR, Project
from tests.studio.night.torture.stage import MODULE
from tests.studio.night.torture.studies import scheduler_killed, study_again


@dataclass(frozen=True)
class Fault:
    """One kind of fault."""

    name: str
    hit: hits.Hit
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
        Fault(f"{what.name} to make", hits.signal_to("make", what), during=FILM, target="run-all")
        for what in (TERM, KILL, *MAKE_TELLS)
    ),
    *(Fault(f"{what.name} to the coordinator", hits.signal_to(COORDINATOR, what)) for what in (TERM, INT, HUP, KILL)),
    *(Fault(f"{what.name} to a stage", hits.signal_to(STAGE, what), during=STAGE) for what in (TERM, INT, KILL)),
    *(Fault(f"{what.name} to Blender", hits.signal_to(BLENDER, what), during=BLENDER) for what in (TERM, KILL, SEGV)),
    Fault("Blender stopped", hits.signal_to(BLENDER, STOP), during=BLENDER),
    Fault("a stage stopped for a while", hits.stop_for_a_while, during=FILM),
    Fault("SIGKILL to ffmpeg", hits.signal_to("ffmpeg", KILL), during="ffmpeg"),
    Fault("a read-only disk", hits.read_only, undo=hits.writable, during=MAKE, target="run-all"),
    Fault("make stop", hits.asked_to_stop),
    Fault("a clock that was set back", hits.clock_set_back),
    Fault("a folder in place of a lock", hits.folder_for_lock),
    Fault("two runs at once", hits.second_run),
    Fault("processes of a live page hit while it follows", live_page_hit, follow=wrong_pages),
    Fault("a picture cut", hits.damaged(hits.pictures, cut), destroys=1),
    Fault("a picture with a flipped byte", hits.damaged(hits.pictures, flipped), destroys=1),
    Fault("a picture deleted", hits.damaged(hits.pictures, gone), destroys=1),
    Fault("two pictures swapped", hits.swapped, destroys=2),
    Fault("no text in a stamp, timing.json or frames.json", hits.damaged(hits.records, no_text)),
    Fault("a stamp, timing.json or frames.json cut", hits.damaged(hits.records, cut)),
    Fault("no text in data.json, parts.json or a solid", hits.damaged(hits.results, no_text)),
    Fault("a result or stamp with a flipped byte", hits.damaged(hits.results, flipped)),
    Fault("the film cut", hits.damaged(hits.film, cut), hits_film=True),
    Fault("the film with a flipped byte", hits.damaged(hits.film, flipped), hits_film=True),
]
if sys.platform == "linux":
    FAULTS += [
        Fault("no room for Blender's files", hits.limited(BLENDER, "files"), during=BLENDER),
        Fault("no room for a stage's files", hits.limited(STAGE, "files"), during=STAGE),
        Fault("no memory for Blender", hits.limited(BLENDER, "memory"), during=BLENDER),
        Fault("no memory for a stage", hits.limited(STAGE, "memory"), during=STAGE),
    ]
BACKGROUND = [Fault("SIGKILL to tmux", hits.signal_to(TMUX, KILL), during=STAGE, target="overnight")]
"""Only where there is tmux."""
FETCH = [Fault("films fetched meanwhile, killed and fetched again", fetch_killed, follow=fetch_again)]
"""Only where there are rsync, ssh and sshd."""
CLUSTER = [
    *(
        Fault(
            f"{what.name} to {whom}", workers.signal_to_one(pick, what), undo=workers.healed, during=FILM, cluster=True
        )
        for whom, pick in (("a worker", workers.Workers.workers), ("a worker's Blender", workers.Workers.blenders))
        for what in (KILL, STOP)
    ),
    Fault(
        "no room for a worker's files",
        workers.limit_one(workers.Workers.workers, "files"),
        undo=workers.healed,
        during=FILM,
        cluster=True,
    ),
    *(
        Fault(
            f"no {what} for a worker's Blender",
            workers.limit_one(workers.Workers.blenders, kind),
            undo=workers.healed,
            during=FILM,
            cluster=True,
        )
        for what, kind in (("room for the files", "files"), ("memory", "memory"))
    ),
    Fault("SIGKILL to the scheduler", workers.no_scheduler, undo=workers.scheduler_again, during=FILM, cluster=True),
    Fault(
        "SIGKILL to the scheduler during a study",
        scheduler_killed,
        undo=workers.scheduler_again,
        during=FILM,
        cluster=True,
        follow=study_again,
    ),
    *(
        Fault(
            f"a worker that sends {kind}",
            workers.is_there,
            before=workers.admitted(kind),
            undo=workers.expelled,
            during=FILM,
            cluster=True,
            ends_well=True,
        )
        for kind in KINDS
    ),
]
"""Only where there are a scheduler and workers, on Linux."""
DISK_OF_ONE = [Fault("a full disk of a worker", workers.disk_of_one, undo=workers.healed, during=FILM, cluster=True)]
"""Only where one of the workers has a small disk of its own."""
FULL = [
    *[Fault("a full disk", hits.full_disk, undo=hits.room_again)] * 2,
    *[Fault("a disk that gets full under Blender", hits.full_disk, undo=hits.room_again, during=BLENDER)] * 3,
]
"""Only where a small disk could be mounted; more likely than each of the others."""
