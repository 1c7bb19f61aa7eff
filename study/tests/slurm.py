# A Slurm of two nodes on this machine: its own controller, two daemons, their ports, keys and folders.
import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

import pytest

MARK = "MBS_CLUSTER_TEST"  # in the environment of all that it starts
NODES = ("node1", "node2")


def missing():
    """Why it cannot be started here; "" if it can."""
    lacking = [name for name in ("slurmctld", "slurmd", "sbatch") if not shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin")]
    return (f"{lacking[0]} is missing: study/setup --cluster" if lacking else
            "slurmd asks for root" if os.geteuid() else "")


class Slurm:
    def __init__(self, folder):
        self.folder, self.mark, self.daemons, self.host = folder, f"{os.getpid()}-{time.time_ns()}", {}, socket.gethostname()
        folder.mkdir()
        for node in NODES:
            (folder / f"locks-{node}").mkdir()  # each is a machine of its own
        prolog = folder / "prolog"
        prolog.write_text(f'#!/bin/bash\necho "export MBS_LOCKS={folder}/locks-$SLURMD_NODENAME"\n')
        prolog.chmod(0o755)
        ports = free_ports(1 + len(NODES))
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**21
        (folder / "slurm.conf").write_text("\n".join([
            "ClusterName=test", f"SlurmctldHost={self.host}(127.0.0.1)", f"SlurmctldPort={ports[0]}", "SlurmUser=root",
            "AuthType=auth/none", "CredType=cred/none", "ProctrackType=proctrack/linuxproc", "TaskPlugin=task/affinity",
            "SelectType=select/linear", "ReturnToService=2", "SlurmdTimeout=10", "KillWait=5", "MessageTimeout=10",
            f"TaskProlog={prolog}", f"StateSaveLocation={folder}/state", f"SlurmdSpoolDir={folder}/spool-%n",
            f"SlurmctldPidFile={folder}/slurmctld.pid", f"SlurmdPidFile={folder}/%n.pid", f"SlurmctldLogFile={folder}/slurmctld.log",
            f"SlurmdLogFile={folder}/%n.log",
            *(f"NodeName={node} NodeHostname={self.host} NodeAddr=127.0.0.1 Port={port} CPUs={os.cpu_count()} RealMemory={memory}"
              for node, port in zip(NODES, ports[1:])),
            f"PartitionName=all Nodes={','.join(NODES)} Default=YES MaxTime=INFINITE State=UP", ""]))
        (folder / "state").mkdir()

    @property
    def environment(self):
        return {"SLURM_CONF": str(self.folder / "slurm.conf"), MARK: self.mark, "PATH": os.environ["PATH"] + ":/usr/sbin"}

    def start(self, *names):
        """The controller ("slurmctld") or nodes."""
        for name in names:
            command = ["slurmctld", "-D"] if name == "slurmctld" else ["slurmd", "-D", "-N", name]
            self.daemons[name] = subprocess.Popen(command, env=os.environ | self.environment | {"MBS_DAEMON": name},
                                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until(lambda: self.ask("sinfo", "-h", "-t", "idle,alloc", "-o", "%D") == str(len(self.nodes)), "nodes answer",
              lambda: self.ask("sinfo", "-N"))

    @property
    def nodes(self):
        return [name for name, daemon in self.daemons.items() if name in NODES and daemon.poll() is None]

    def ask(self, *words):
        return subprocess.run(words, env=os.environ | self.environment, capture_output=True, text=True, timeout=60).stdout.strip()

    def lose(self, node):
        """The node is gone: its daemon and all that ran on it, at once."""
        gone = [pid for pid, words in self.processes().items()
                if f"SLURMD_NODENAME={node}" in words or f"MBS_DAEMON={node}" in words]
        for pid in gone:
            kill(pid)
        self.daemons.pop(node).wait()

    def processes(self):
        """{pid: environment} of all that belongs to it."""
        found = {}
        for path in Path("/proc").glob("[0-9]*/environ"):
            try:
                words = path.read_bytes().decode("utf-8", "replace").split("\0")
            except OSError:
                continue
            if f"{MARK}={self.mark}" in words and path.parent.name != str(os.getpid()):
                found[int(path.parent.name)] = words
        return found

    def end(self):
        """Ends every process that was started; fails if one stays."""
        end = time.monotonic() + 30
        while (left := self.processes()) and time.monotonic() < end:
            for pid in left:
                kill(pid)
            for daemon in self.daemons.values():
                daemon.poll()
            time.sleep(0.2)
        assert not self.processes()


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    found = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return found


def until(holds, what, told=lambda: "", seconds=120):
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            pytest.fail(f"not within {seconds} s: {what}; {told()}")
        time.sleep(0.2)
