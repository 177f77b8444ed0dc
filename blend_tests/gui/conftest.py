# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender with a window, for tests that tools/gui_test.sh starts; other runs do not collect
them.
"""

import shutil
import sys
from pathlib import Path

import pytest

if shutil.which("xdotool") is None or not Path("/out").is_dir():
    collect_ignore_glob = ["*.py"]
else:
    sys.path.insert(0, str(Path(__file__).parent))
    import numpy as np
    from quadric import Camera, Sheet, height
    from session import BlenderSession, virtual_screen

    @pytest.fixture(scope="session")
    def screen():
        with virtual_screen() as display:
            yield display

    @pytest.fixture(scope="session")
    def session(screen, tmp_path_factory):
        with BlenderSession(screen, tmp_path_factory.mktemp("user")) as session:
            yield session

    @pytest.fixture
    def blender(session):
        """Returns Blender with a new file, the extension enabled, and the mouse in the middle of
        the viewport.
        """
        session.new_file()
        return session

    @pytest.fixture
    def sheet(blender):
        found = Sheet(blender.call("sheet"))
        blender.settle()
        return found

    @pytest.fixture
    def seen(blender, sheet):
        """Returns the pixel, in whole numbers, at which a local point of the sheet is seen."""
        camera = Camera(**blender.call("camera"))
        return lambda x, y: np.round(camera.pixel(sheet.world(np.array([x, y, height(x, y)]))))
