# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Standard streams that are closed or disappear, and full folders for temporary files."""
import os
import pty
import signal
import subprocess
import time

import pytest

import cases
import interposed

STUDY = ("reproduce", "-o", "study", "--scenario", "small.json", "--mesh", "mesh.node", "--steps", "2", "--runs", "1",
         "--budget", "0.05", "--no-pin", "-q")


@pytest.mark.parametrize("closed", [(0, 1), (0, 1, 2)])
def test_a_study_ends_where_streams_are_closed(tmp_path, closed):
    """The sockets to its child processes must not get the numbers of the closed streams."""
    cases.scenario(tmp_path)

    def close():
        for stream in closed:
            os.close(stream)

    done = subprocess.run([interposed.MESHORDER, *STUDY], cwd=tmp_path, preexec_fn=close, capture_output=True, text=True,
                          timeout=interposed.SECONDS, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "study" / "results.json").exists()


def test_a_terminal_that_goes_away_ends_no_simulation(tmp_path):
    """The progress line cannot be written any more, as after nohup."""
    cases.scenario(tmp_path)
    terminal, stderr = pty.openpty()
    with subprocess.Popen([interposed.MESHORDER, "simulate", "small.json", "--steps", "1000000"], cwd=tmp_path,
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=stderr,
                          preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)) as child:
        os.close(stderr)
        assert b"%" in os.read(terminal, 100)  # the first line, after two seconds
        os.close(terminal)
        time.sleep(1)
        assert child.poll() is None, child.returncode
        child.terminate()  # SIGINT is ignored in processes that a shell has put into the background
        child.wait(timeout=interposed.SECONDS)
    assert child.returncode in (0, 128 + signal.SIGTERM, -signal.SIGTERM)
