"""Ctrl-C while the command line is imported ends the process like any other in a shell: no traceback."""

import os
import runpy
import signal
import subprocess
import sys

import pytest

PROGRAM = """
import signal, sys

class Waits:
    def find_spec(self, name, path=None, target=None):
        if name == "pinocchio":
            print("importing", flush=True)
            signal.pause()

sys.meta_path.insert(0, Waits())
from pin_metaik_command import run
run()
"""


@pytest.mark.skipif(not hasattr(signal, "pause"), reason="no POSIX signals")
def test_ctrl_c_during_the_import_leaves_no_traceback() -> None:
    with subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"importing\n"
        os.kill(process.pid, signal.SIGINT)
        _, errors = process.communicate(timeout=120)
    assert (process.returncode, errors) == (-signal.SIGINT, b"")


def test_after_the_import_ctrl_c_is_what_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["pin-metaik", "--version"])
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(SystemExit) as ended:
        runpy.run_module("pin_metaik")
    assert not ended.value.code
    assert signal.getsignal(signal.SIGINT) is before
