"""A failure is shown when it happens, not after the last test."""

from __future__ import annotations

import pytest


class Failures:
    """Prints a line for each failure at once; the whole report of it still comes at the end."""

    def __init__(self, config: pytest.Config) -> None:
        self.config = config

    @pytest.hookimpl(trylast=True)
    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """One phase of one test."""
        terminal = self.config.pluginmanager.get_plugin("terminalreporter")
        if report.failed and terminal is not None:
            crash = getattr(report.longrepr, "reprcrash", None)
            reason = " ".join(crash.message.split())[:200] if crash else ""
            if terminal.verbosity < 0:  # quietly, dots stand on the line that is open
                terminal.write("\n")
            terminal.write_line(f"FAILED {report.nodeid}: {reason}", red=True)
