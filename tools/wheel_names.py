# SPDX-License-Identifier: Apache-2.0
"""What the file names of wheels say: NAME-VERSION-PYTHON-ABI-PLATFORM.whl, where PLATFORM may hold
several tags with points between.
"""

from pathlib import Path

#: Blender's names for systems and processors, by the beginning and the end of a wheel's tag
SYSTEMS = {"manylinux": "linux", "win": "windows", "macosx": "macos"}
PROCESSORS = {
    "x86_64": ("x64",),
    "amd64": ("x64",),
    "aarch64": ("arm64",),
    "arm64": ("arm64",),
    "universal2": ("arm64", "x64"),
}


def version(wheel: Path) -> str:
    return wheel.stem.split("-")[1]


def python(wheel: Path) -> str:
    """Returns a name such as cp313."""
    return wheel.stem.split("-")[-3]


def platform_tags(wheel: Path) -> list[str]:
    return wheel.stem.split("-")[-1].split(".")


def blender_platforms(wheel: Path) -> list[str]:
    """Returns Blender's names of the platforms, such as linux-x64. Raises ValueError for a tag that
    Blender does not run on.
    """
    return sorted({name for tag in platform_tags(wheel) for name in _blender_names(tag, wheel)})


def _blender_names(tag: str, wheel: Path) -> list[str]:
    for begin, system in SYSTEMS.items():
        for end, processors in PROCESSORS.items():
            if tag.startswith(begin) and tag.endswith(f"_{end}"):
                return [f"{system}-{processor}" for processor in processors]
    raise ValueError(f"{wheel.name} is for {tag}, on which Blender does not run")
