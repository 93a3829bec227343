"""When the server is killed, nothing of what the author's code has begun goes on."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from studio.live.processes.trees import MARK
from tests.running.processes import until
from tests.studio.live.arm import ARM
from tests.studio.live.served import WAIT, processes_of

BEGINS = """
import ctypes
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
subprocess.Popen([sys.executable, "-c", "import os, time; os.fork() or os.setsid(); time.sleep(600)"],
                 start_new_session=True)
if os.fork() == 0:
    ctypes.PyDLL(None).sleep(600)  # holds Python's lock
"""
LOOPS = BEGINS + '(HERE / "making").touch()\nwhile True:\n    pass\n'


@pytest.mark.skipif(sys.platform != "linux", reason="reads the environment of other processes in /proc")
def test_nothing_outlives_a_server_that_was_killed(tmp_path: Path) -> None:
    """Servers that end in order are checked by each test that has one (served.py)."""
    folder = tmp_path / "mechanisms"
    (folder / "arm").mkdir(parents=True)
    (folder / "arm" / "mechanism.py").write_text(ARM + BEGINS)
    (folder / "arm" / "parts.py").write_text(LOOPS)
    environment = os.environ | {"MBSD_TEST_PARTS": str(folder), "MBSD_OUT": str(tmp_path / "out")}
    command = [sys.executable, "-m", "tests.studio.live.serving", "arm"]
    with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, start_new_session=True) as server:
        try:
            until((folder / "arm" / "making").exists, WAIT)
            warm = next(
                child for child in psutil.Process(server.pid).children() if "forking" in " ".join(child.cmdline())
            )
            mark = warm.environ()[MARK]
            assert len(processes_of(mark)) >= 9, "the warm process, two keepers, what they keep and what that has begun"
            server.kill()
            server.wait(WAIT)
            until(lambda: not processes_of(mark), WAIT)
        finally:
            server.kill()
