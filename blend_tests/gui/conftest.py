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
