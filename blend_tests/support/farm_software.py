# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs of farms, in folders of their own in build/farm: Python's by pip, Slurm from
Debian's packages. Nothing is installed on the system.

Tests are skipped where they cannot be had, with the reason.
"""

import fcntl
import hashlib
import os
import shutil
import socket
import subprocess
import sys
import sysconfig
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from processes import ROOT

FOLDER = ROOT / "build/farm"
REQUIREMENTS = ROOT / "blend_tests/farm/requirements.txt"
SLURM_PACKAGES = ("slurmctld", "slurmd", "slurm-client", "munge")
HOST = socket.gethostname().split(".")[0]
LIMIT = 600  # seconds after which a download is given up
START_LIMIT = 60  # seconds in which Slurm has to start


def python_environment() -> Path:
    """Returns the folder of an environment with the requirements, and with all that this one
    has.
    """
    stamp = _digest(REQUIREMENTS.read_text(), sys.prefix, sys.version)
    with _made_once(FOLDER / "python", stamp) as folder:
        if folder:
            _run_or_skip("pip", sys.executable, "-m", "venv", folder)
            python = folder / "bin/python"
            _run_or_skip(
                "pip", python, "-m", "pip", "install", "-q", "--disable-pip-version-check",
                "-r", REQUIREMENTS,
            )  # fmt: skip
            (packages,) = folder.glob("lib/python*/site-packages")
            (packages / "these.pth").write_text(sysconfig.get_paths()["platlib"] + "\n")
    return FOLDER / "python"


def _slurm_folder() -> Path:
    if shutil.which("apt-get") is None or shutil.which("dpkg-deb") is None:
        pytest.skip("SLURM IS NOT TESTED HERE: its packages are taken from Debian's apt")
    with _made_once(FOLDER / "slurm", _digest(*SLURM_PACKAGES)) as folder:
        if folder:
            archives = folder / "archives"
            (archives / "partial").mkdir(parents=True)
            _run_or_skip(
                "apt-get", "apt-get", "install", "-y", "--download-only", "--reinstall",
                "--no-install-recommends", "-o", f"Dir::Cache::archives={archives}",
                "-o", "Debug::NoLocking=1", *SLURM_PACKAGES,
            )  # fmt: skip
            for package in sorted(archives.glob("*.deb")):
                _run_or_skip("dpkg-deb", "dpkg-deb", "-x", package, folder / "root")
    return FOLDER / "slurm/root"


@contextmanager
def slurm() -> Iterator[dict[str, str]]:
    """Runs a cluster of one machine, which is this one, and yields the environment variables with
    which its commands find it.
    """
    if os.geteuid() != 0:
        pytest.skip("SLURM IS NOT TESTED HERE: its daemons need the rights of root")
    root = _slurm_folder()
    libraries = root / "usr/lib/x86_64-linux-gnu"
    with ExitStack() as stack:
        # the name of a socket has to be short
        run = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="slurm-")))
        run.chmod(0o755)
        environment = os.environ | {
            "PATH": f"{root}/usr/bin:{os.environ['PATH']}",
            "LD_LIBRARY_PATH": f"{libraries}:{libraries}/slurm-wlm",
            "SLURM_CONF": str(run / "slurm.conf"),
        }
        (run / "munge.key").write_bytes(os.urandom(1024))
        (run / "munge.key").chmod(0o400)
        (run / "slurm.conf").write_text(_configuration(run, libraries / "slurm-wlm"))
        programs = root / "usr/sbin"
        names = ("key-file", "socket", "pid-file", "log-file", "seed-file")
        files = [f"--{name}={run}/munge.{name.split('-')[0]}" for name in names]
        for name, *arguments in (
            ("munged", "--foreground", "--force", *files),
            ("slurmctld-wlm", "-D"),
            ("slurmd-wlm", "-D", "-N", HOST, "-d", programs / "slurmstepd-wlm"),
        ):
            log = stack.enter_context((run / f"{name}.out").open("w"))
            process = subprocess.Popen(
                [programs / name, *arguments], env=environment, stdout=log, stderr=log
            )
            stack.callback(_stop, process)
        _await_idle(environment, run)
        yield environment


def _configuration(run: Path, plugins: Path) -> str:
    controller, daemon = _free_ports(2)
    for name in ("state", "spool"):
        (run / name).mkdir()
    return f"""\
ClusterName=test
SlurmctldHost={HOST}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={run}/munge.socket
CredType=cred/munge
PluginDir={plugins}
StateSaveLocation={run}/state
SlurmdSpoolDir={run}/spool
SlurmctldPidFile={run}/slurmctld.pid
SlurmdPidFile={run}/slurmd.pid
SlurmctldLogFile={run}/slurmctld.log
SlurmdLogFile={run}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=1
MailProg=/bin/true
NodeName={HOST} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes={HOST} Default=YES MaxTime=INFINITE State=UP
"""


def _free_ports(count: int) -> list[int]:
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]


def _await_idle(environment: dict[str, str], run: Path) -> None:
    deadline = time.monotonic() + START_LIMIT
    while time.monotonic() < deadline:
        found = subprocess.run(
            ["sinfo", "-h", "-o", "%t"], env=environment, capture_output=True, text=True
        )
        if found.stdout.strip() == "idle":
            return
        time.sleep(0.2)
    logs = "\n".join(path.read_text() for path in sorted(run.glob("*.out")))
    pytest.fail(f"Slurm has not started within {START_LIMIT} s:\n{logs}")


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(timeout=30)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


@contextmanager
def _made_once(folder: Path, stamp: str) -> Iterator[Path | None]:
    """Yields the folder, empty, if it is to be made; None if it is there. Others wait meanwhile."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    done = folder.with_suffix(".made")
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if done.is_file() and done.read_text() == stamp and folder.is_dir():
            yield None
            return
        done.unlink(missing_ok=True)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        yield folder
        done.write_text(stamp)


def _run_or_skip(what: str, *command: str | Path) -> None:
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    if done.returncode:
        last = (done.stderr or done.stdout).strip().splitlines()[-1:]
        pytest.skip(f"NOT TESTED HERE: {what} could not fetch the software: {' '.join(last)}")


def _digest(*parts: str) -> str:
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def run(
    command: Sequence[str | Path], environment: dict[str, str] | None = None, **options: object
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=LIMIT, **options
    )
