# SPDX-License-Identifier: Apache-2.0
"""Makes a skipped test a failure: tools/setup test installs everything that these tests need."""


def pytest_sessionfinish(session, exitstatus):
    skipped = session.config.pluginmanager.get_plugin("terminalreporter").stats.get("skipped", [])
    for report in skipped:
        print(f"\nFAILED: {report.nodeid} was skipped: {report.longrepr}")
    if skipped and exitstatus == 0:
        session.exitstatus = 1
