"""A display without a monitor, whose picture can be taken."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np


class Screen:
    """Of the size in pixels, while a `with` lasts; `environment` is for programs that are to show on it."""

    def __init__(self, width, height):
        self._folder = tempfile.TemporaryDirectory()
        ready, tell = os.pipe()
        try:
            self._server = subprocess.Popen(
                ["Xvfb", "-displayfd", str(tell), "-screen", "0", f"{width}x{height}x24", "-fbdir",
                 self._folder.name, "-nolisten", "tcp", "-nocursor"], pass_fds=[tell], stderr=subprocess.DEVNULL)
        except FileNotFoundError:
            sys.exit("study: no Xvfb; install what scripts/study_packages lists")
        finally:
            os.close(tell)
        with os.fdopen(ready) as answer:
            self._display = answer.readline().strip()
        if not self._display:
            sys.exit("study: Xvfb did not start")
        self.environment = {"DISPLAY": f":{self._display}", "LIBGL_ALWAYS_SOFTWARE": "1"}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._server.terminate()
        self._server.wait()
        self._folder.cleanup()

    def picture(self):
        """Rows of pixels of red, green and blue bytes, from the X window dump that Xvfb keeps."""
        data = (Path(self._folder.name) / "Xvfb_screen0").read_bytes()
        head = np.frombuffer(data, ">u4", 25)
        width, height, stride, colors = head[4], head[5], head[12], head[19]
        begin = head[0] + 12 * colors
        rows = np.frombuffer(data, np.uint8, height * stride, begin).reshape(height, stride)
        # Xvfb on a little-endian machine: blue, green, red, unused.
        return rows[:, :4 * width].reshape(height, width, 4)[:, :, 2::-1]
