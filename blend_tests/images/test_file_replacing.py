# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are replaced together."""

import os

import pytest
from limit_surface.errors import RefusalError
from limit_surface.images import file_replacing


def write_both(folder, then=lambda: None):
    with file_replacing.all_or_none() as files:
        for name in ("old.exr", "new.exr"):
            files.beside(folder / name).write_text("written")
        assert (folder / "old.exr").read_text() == "before"
        files.place()
        assert (folder / "old.exr").read_text() == "written"
        then()


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "old.exr").write_text("before")
    return tmp_path


def contents(folder):
    return {path.name: path.read_text() for path in folder.iterdir()}


def test_files_take_their_places(folder):
    (folder / "old.exr").chmod(0o640)
    write_both(folder)
    assert contents(folder) == {"old.exr": "written", "new.exr": "written"}
    assert (folder / "old.exr").stat().st_mode & 0o777 == 0o640


def test_a_later_error_takes_all_of_them_back(folder):
    def fails():
        raise RefusalError("later")

    with pytest.raises(RefusalError, match="later"):
        write_both(folder, fails)
    assert contents(folder) == {"old.exr": "before"}


def test_a_file_that_cannot_take_its_place_takes_all_of_them_back(folder, monkeypatch):
    replace = os.replace

    def fails(source, path):
        if str(path).endswith("new.exr"):
            raise PermissionError(13, "Permission denied")
        replace(source, path)

    monkeypatch.setattr(os, "replace", fails)
    with pytest.raises(RefusalError, match="new.exr cannot be written: Permission denied"):
        write_both(folder)
    assert contents(folder) == {"old.exr": "before"}


def test_a_folder_is_not_replaced(folder):
    (folder / "maps.exr").mkdir()

    def write():
        with file_replacing.all_or_none() as files:
            files.beside(folder / "old.exr").write_text("written")
            files.beside(folder / "maps.exr")

    with pytest.raises(RefusalError, match="maps.exr cannot be written: it is a folder"):
        write()
    assert (folder / "old.exr").read_text() == "before"
    assert sorted(path.name for path in folder.iterdir()) == ["maps.exr", "old.exr"]


def test_links_go_on_leading_to_their_file(folder, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "real.exr"
    elsewhere.write_text("before")
    (folder / "old.exr").unlink()
    (folder / "old.exr").symlink_to(elsewhere)
    write_both(folder)
    assert (folder / "old.exr").is_symlink()
    assert elsewhere.read_text() == "written"
    assert sorted(path.name for path in elsewhere.parent.iterdir()) == ["real.exr"]
