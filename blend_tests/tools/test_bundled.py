# SPDX-License-Identifier: GPL-3.0-or-later
"""A wheel with OpenSubdiv and oneTBB inside the module: it needs no other libraries, and `bpy` can
be imported after it. The sources are those of the system's distribution.
"""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from elftools.elf.elffile import ELFFile
from processes import ROOT, run_python
from wheel_names import platform_tags

LIBRARIES = {"opensubdiv": "opensubdiv", "onetbb": "tbb"}
#: Libraries of the system, which every manylinux wheel may expect
SYSTEM = {"ld-linux-x86-64.so.2", "libc.so.6", "libgcc_s.so.1", "libm.so.6", "libstdc++.so.6"}
#: The same before glibc 2.34, which took two of them into itself; Zig's C++ library is in the wheel
SYSTEM_OF_OLD_GLIBC = {
    *("ld-linux-x86-64.so.2", "libc.so.6", "libdl.so.2", "libm.so.6", "libpthread.so.0"),
}
SOURCE_LIST = Path("/etc/apt/sources.list.d/debian.sources")


@pytest.fixture(scope="module")
def sources(tmp_path_factory) -> Path:
    """Fetches the sources as folders `opensubdiv` and `tbb`."""
    if not SOURCE_LIST.exists():
        pytest.skip(f"{SOURCE_LIST} is missing: no sources of packages here")
    folder = tmp_path_factory.mktemp("sources")
    for part in ("lists", "parts"):
        (folder / part).mkdir()
    sources = SOURCE_LIST.read_text().replace("Types: deb\n", "Types: deb-src\n")
    (folder / "parts/debian.sources").write_text(sources)
    apt = [
        "apt-get",
        "-qq",
        *("-o", "Dir::Etc::sourcelist=/dev/null"),
        *("-o", f"Dir::Etc::sourceparts={folder / 'parts'}"),
        *("-o", f"Dir::State::lists={folder / 'lists'}"),
    ]
    for command in (["update"], ["source", "--download-only", *LIBRARIES]):
        done = subprocess.run([*apt, *command], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            pytest.skip(f"apt-get {command[0]} cannot fetch sources here: {done.stderr}")
    for package, name in LIBRARIES.items():
        (archive,) = folder.glob(f"{package}_*.orig.tar.*")
        (folder / name).mkdir()
        subprocess.run(
            ["tar", "-xf", archive, "--strip-components=1", "-C", folder / name], check=True
        )
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("glibc", [None, "2.28"])
def test_wheel_needs_no_other_libraries(sources, tmp_path, glibc):
    options = ["--build-wheel", "--bundled", "--sources", sources]
    if glibc is not None:
        pytest.importorskip("ziglang", reason="Zig is missing (pip install ziglang)")
        options += ["--glibc", glibc]
    done = subprocess.run(
        [
            *(sys.executable, ROOT / "tools/build_extension.py", *options),
            *("--wheels", tmp_path / "wheels", "--output", tmp_path),
        ],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (wheel,) = (tmp_path / "wheels").glob("*.whl")
    with zipfile.ZipFile(wheel) as contents:
        names = contents.namelist()
        contents.extractall(tmp_path / "site")
    assert [Path(name).parent.name for name in names if ".so" in name] == ["limitsurf"]
    (module,) = (tmp_path / "site/limitsurf").glob("*.so")
    with module.open("rb") as file:
        tags = list(ELFFile(file).get_section_by_name(".dynamic").iter_tags())
    needed = {tag.needed for tag in tags if tag.entry.d_tag == "DT_NEEDED"}
    assert needed <= (SYSTEM if glibc is None else SYSTEM_OF_OLD_GLIBC)
    if glibc is not None:
        floors = [int(tag.split("_")[2]) for tag in platform_tags(wheel) if tag.count("_") > 2]
        assert floors, wheel.name
        assert max(floors) <= int(glibc.split(".")[1]), wheel.name
    assert any(name.endswith("LICENSES/OpenSubdiv.txt") for name in names)
    assert not any("GPL" in name for name in names)
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path / 'site')!r}); import limitsurf, bpy, os\n"
        f"assert limitsurf.__file__.startswith({str(tmp_path)!r}), limitsurf.__file__\n"
        "mesh = limitsurf.ControlMesh.from_faces([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\n"
        "places = limitsurf.LimitSurface(mesh).scatter_uniform(1000, threads=2)\n"
        "print(len(places), flush=True)\n"
        "os._exit(0)  # the module bpy does not always end by itself\n"
    )
    assert run_python(code).stdout.strip() == "1000"
