"""`acts view` as a person starts it; ROS_DOMAIN_ID 221."""

from __future__ import annotations

import http.client
import os
import re
import signal
import subprocess
import sys

from acts_core.errors import REFUSED_EXIT_CODE

DEADLINE_S = 60.0


def start(*words: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "acts_tools", "view", *words],
        env={**os.environ, "ROS_DOMAIN_ID": "221"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def test_it_prints_where_the_page_is_and_ends_in_order() -> None:
    with start("plate", "--port", "0") as process:
        try:
            assert process.stdout is not None
            found = next(
                found for line in process.stdout if (found := re.search(r"open http://127\.0\.0\.1:(\d+)/", line))
            )
            connection = http.client.HTTPConnection("127.0.0.1", int(found[1]), timeout=DEADLINE_S)
            connection.request("GET", "/")
            assert connection.getresponse().status == 200
            # Taken meanwhile: said in a line.
            second = subprocess.run(
                [sys.executable, "-m", "acts_tools", "view", "--port", found[1]],
                env={**os.environ, "ROS_DOMAIN_ID": "221"},
                capture_output=True,
                text=True,
                timeout=DEADLINE_S,
            )
            assert second.returncode == REFUSED_EXIT_CODE
            assert f"error: cannot listen on 127.0.0.1 port {found[1]}" in second.stderr
            process.send_signal(signal.SIGINT)
            assert process.wait(DEADLINE_S) == 0
        finally:
            process.kill()
