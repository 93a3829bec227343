"""A line between ssh and sshd that counts what comes back, and hangs after so many bytes, then breaks.

``python relay.py PORT COUNT_FILE [MOST]`` as ssh's ProxyCommand.
"""

from __future__ import annotations

import os
import select
import socket
import sys
import time
from pathlib import Path

port, counted, most = int(sys.argv[1]), Path(sys.argv[2]), int((sys.argv[3:] or ["0"])[0])
try:
    line = socket.create_connection(("127.0.0.1", port))
except OSError as error:
    sys.exit(f"relay: {error}")
back = 0
while True:
    ready = select.select([0, line], [], [])[0]
    if 0 in ready:
        content = os.read(0, 65536)
        if not content:
            break
        line.sendall(content)
    if line in ready:
        content = line.recv(65536)
        if not content:
            break
        back += len(content)
        counted.write_text(str(back))
        if most and back > most:
            time.sleep(6)
            break
        while content:
            content = content[os.write(1, content) :]
