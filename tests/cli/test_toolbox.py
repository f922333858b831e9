"""``pin-metaik toolbox``: quick to start, nothing left after Ctrl-C, what makes no sense is told."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from urllib.request import urlopen

import pytest

from pin_metaik.errors import InvalidSetting

pytest.importorskip("viser")

COMMAND = [sys.executable, "-m", "pin_metaik", "toolbox", "--no-browser", "--port"]
QUICK = 3.0  # s of the processor until it listens


@pytest.mark.skipif(sys.platform != "linux", reason="/proc tells what a process has used")
def test_it_starts_within_seconds_answers_on_loopback_and_ends_at_ctrl_c() -> None:
    with subprocess.Popen([*COMMAND, "0"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as started:
        assert started.stdout is not None
        line = started.stdout.readline()
        fields = Path(f"/proc/{started.pid}/stat").read_text().rpartition(")")[2].split()
        assert (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK") < QUICK
        with urlopen(line.split()[4], timeout=60) as page:
            assert b"viser" in page.read().lower()
        started.send_signal(signal.SIGINT)
        _, errors = started.communicate(timeout=60)
    assert started.returncode == 130
    assert "Traceback" not in errors


def test_the_package_is_imported_without_it_and_a_port_that_is_taken_is_told() -> None:
    code = "import sys, pin_metaik; assert not {'viser', 'pin_metaik.gui'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
    from pin_metaik.gui import open_toolbox

    with open_toolbox(port=0) as toolbox:
        taken = int(toolbox.url.rstrip("/").rpartition(":")[2])
        with pytest.raises(InvalidSetting, match="port 0 is any that is free"):
            open_toolbox(port=taken)
    with pytest.raises(InvalidSetting, match="a port is 0 to 65535"):
        open_toolbox(port=70_000)
