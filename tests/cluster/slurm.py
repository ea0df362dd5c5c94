"""A real Slurm of one node: munged, slurmctld and slurmd on loopback, all that they keep in one temporary folder.

Runs as root and as an ordinary user, beside a Slurm that the machine may have.
"""

import contextlib
import getpass
import os
import platform
import secrets
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel", "sinfo")
# Where daemons are, if not in the path of an ordinary user.
_SYSTEM = ("/usr/sbin", "/sbin", "/usr/local/sbin")
_PATIENCE = 30.0

# Credentials that live for seconds, or a job that was requeued would wait for two minutes.
_CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=5
CredType=cred/munge
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=2
MinJobAge=600
JobRequeue=1
PropagateResourceLimits=NONE
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} Boards=1 SocketsPerBoard=1 CoresPerSocket={cpus} ThreadsPerCore=1 \
RealMemory={megabytes} State=UNKNOWN
PartitionName=debug Nodes={host} Default=YES MaxTime=INFINITE DefaultTime=60 State=UP OverSubscribe=NO
"""


def missing():
    """Programs of Slurm that this machine has not."""
    return [name for name in PROGRAMS if _found(name) is None]


def _found(name):
    return shutil.which(name, path=os.pathsep.join([os.environ.get("PATH", ""), *_SYSTEM]))


class Slurm:
    """A Slurm of one node.

    Parameters
    ----------
    cpus : int
        Processors of the node, whatever the machine has.

    Attributes
    ----------
    environment : dict of str to str
        Variables with which its commands find it.
    """

    def __init__(self, cpus):
        # A socket's path must be short.
        self.folder = Path(tempfile.mkdtemp(prefix="slurm-"))
        self.environment = {"SLURM_CONF": str(self.folder / "slurm.conf")}
        self._started = []
        try:
            self._start(cpus)
        except BaseException:
            self.stop()
            raise

    def _start(self, cpus):
        # munged insists on these.
        self.folder.chmod(0o755)
        for name in ("state", "spool", "munge"):
            (self.folder / name).mkdir()
        (self.folder / "munge").chmod(0o711)
        key = self.folder / "munge.key"
        key.touch(0o600)
        key.write_bytes(secrets.token_bytes(128))
        # Ports that are free now.
        with socket.socket() as one, socket.socket() as other:
            one.bind(("127.0.0.1", 0))
            other.bind(("127.0.0.1", 0))
            ports = one.getsockname()[1], other.getsockname()[1]
        host = platform.node().partition(".")[0]
        (self.folder / "slurm.conf").write_text(
            _CONFIGURATION.format(
                host=host,
                controller_port=ports[0],
                node_port=ports[1],
                user=getpass.getuser(),
                folder=self.folder,
                cpus=cpus,
                megabytes=int(0.8 * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**20),
            )
        )
        munge = self.folder / "munge"
        places = {"socket": "socket", "pid-file": "pid", "log-file": "log", "seed-file": "seed"}
        options = [f"--{name}={munge / place}" for name, place in places.items()]
        # The folder lies in one that all may write to.
        self._daemon("munged", "--force", f"--key-file={key}", "--num-threads=2", *options, pid=munge / "pid")
        configuration = self.environment["SLURM_CONF"]
        self._daemon("slurmctld", "-f", configuration, pid=self.folder / "slurmctld.pid")
        self._daemon("slurmd", "-f", configuration, "-N", host, pid=self.folder / "slurmd.pid")
        self.wait(lambda: self.run("sinfo", "-h", "-o", "%T", check=False).strip() == "idle", "the node is not idle")

    def _daemon(self, name, *arguments, pid):
        subprocess.run([_found(name), *arguments], env=self._variables(), check=True, capture_output=True, timeout=30)
        self._started.append(pid)

    def _variables(self):
        return {**os.environ, **self.environment}

    def run(self, *command, check=True):
        """What a command of Slurm prints."""
        done = subprocess.run(command, env=self._variables(), capture_output=True, text=True, timeout=60)
        assert done.returncode == 0 or not check, done.stderr
        return done.stdout

    def wait(self, met, what, patience=_PATIENCE):
        """Wait until something is met; fail with what it is and the ends of the logs."""
        last = time.monotonic() + patience
        while not met():
            if time.monotonic() > last:
                raise AssertionError(f"{what}\n{self.run('squeue', check=False)}\n{self._logs()}")
            time.sleep(0.1)

    def states(self, job):
        """States of a job, or of all tasks of an array: ``{"3_1": "RUNNING"}``, those that wait together as one."""
        lines = self.run("squeue", "-h", "-r", "-t", "all", "-j", str(job), "-o", "%i %T").splitlines()
        return dict(line.split() for line in lines)

    def finish(self, job, patience=240.0):
        """Wait for a job, and return its states."""
        self.wait(lambda: not self.run("squeue", "-h", "-j", str(job)).strip(), f"job {job} does not end", patience)
        return self.states(job)

    def _logs(self):
        return "\n".join(
            f"{path.name}:\n{''.join(path.read_text(errors='replace').splitlines(True)[-15:])}"
            for path in sorted(self.folder.glob("*.log"))
        )

    def stop(self):
        """End everything, by the process numbers of what was started."""
        with contextlib.suppress(Exception):
            jobs = self.run("squeue", "-h", "-o", "%A").split()
            if jobs:
                self.run("scancel", *jobs)
                self.wait(lambda: not self.run("squeue", "-h").strip(), "jobs do not end", 10.0)
        numbers = [int(path.read_text()) for path in reversed(self._started) if path.exists()]
        for number in numbers:
            _signal(number, signal.SIGTERM)
        last = time.monotonic() + 10.0
        while any(_signal(number, 0) for number in numbers) and time.monotonic() < last:
            time.sleep(0.1)
        for number in numbers:
            _signal(number, signal.SIGKILL)
        shutil.rmtree(self.folder, ignore_errors=True)


def _signal(number, which):
    """Send a signal; whether there is such a process."""
    try:
        os.kill(number, which)
    except ProcessLookupError:
        return False
    return True
