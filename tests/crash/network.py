"""Machines of a test: network namespaces on two bridges, which are there as long as the test is.

The process of the test moves into a namespace of its own, so that nothing of it is seen by the machine and all of it goes with the
process. Every host is a further namespace with an address on the front, where clients are, and one on the back, where the databases are.
"""
from __future__ import annotations

import ctypes
import os
import signal
import subprocess
from collections.abc import Callable

CLONE_NEWNET = 0x40000000
PR_SET_PDEATHSIG = 1
LIBC = ctypes.CDLL(None, use_errno=True)
FRONT, BACK = "10.78.0", "10.77.0"


def ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True)


def end_with_parent(how: int = signal.SIGKILL) -> None:
    LIBC.prctl(PR_SET_PDEATHSIG, how)


def move_into_a_network() -> str:
    """The process gets a network with both bridges. What the kernel refuses, in a sentence; nothing where it is done."""
    if os.geteuid() != 0:
        return "network namespaces need root"
    if LIBC.unshare(CLONE_NEWNET) != 0:
        return f"the kernel gives no network namespace: {os.strerror(ctypes.get_errno())}"
    try:
        ip("link", "set", "lo", "up")
        for bridge, network in (("front", FRONT), ("back", BACK)):
            ip("link", "add", bridge, "type", "bridge")
            ip("addr", "add", f"{network}.254/24", "dev", bridge)
            ip("link", "set", bridge, "up")
        Host("probe", 253).end()
    except (OSError, subprocess.CalledProcessError) as refused:
        told = getattr(refused, "stderr", b"") or str(refused).encode()
        return f"the kernel gives no bridge or no pair of interfaces: {told.decode().strip()}"
    return ""


class Host:
    """One namespace. `number`: the last part of its addresses."""

    def __init__(self, name: str, number: int) -> None:
        self.name, self.number = name, number
        self.front, self.back = f"{FRONT}.{number}", f"{BACK}.{number}"
        self.holder = subprocess.Popen(["sleep", "infinity"], preexec_fn=self._begin)
        for bridge, address in (("front", self.front), ("back", self.back)):
            ours = f"{bridge}{number}"
            ip("link", "add", ours, "type", "veth", "peer", "name", bridge, "netns", str(self.holder.pid))
            ip("link", "set", ours, "master", bridge, "up")
            self.run("ip", "addr", "add", f"{address}/24", "dev", bridge)
            self.run("ip", "link", "set", bridge, "up")
        self.run("ip", "link", "set", "lo", "up")

    @staticmethod
    def _begin() -> None:
        end_with_parent()
        if LIBC.unshare(CLONE_NEWNET) != 0:
            raise OSError(ctypes.get_errno(), "unshare")

    def run(self, *words: str) -> None:
        subprocess.run(words, check=True, capture_output=True, preexec_fn=self.enter)

    def enter(self) -> None:
        """In a child, before its program begins."""
        space = os.open(f"/proc/{self.holder.pid}/ns/net", os.O_RDONLY)
        if LIBC.setns(space, CLONE_NEWNET) != 0:
            raise OSError(ctypes.get_errno(), "setns")
        os.close(space)

    def enter_and_end_with_parent(self) -> None:
        self.enter()
        end_with_parent()

    def cut_off(self) -> None:
        """From everything on the back: packets go nowhere, and nobody is told."""
        ip("link", "set", f"back{self.number}", "nomaster")

    def connect(self) -> None:
        ip("link", "set", f"back{self.number}", "master", "back")

    def slow(self, *discipline: str) -> None:
        """Queues what goes to it and what comes from it on the back: `netem delay 50ms`, `tbf rate ...`."""
        subprocess.run(["tc", "qdisc", "replace", "dev", f"back{self.number}", "root", *discipline], check=True, capture_output=True)
        self.run("tc", "qdisc", "replace", "dev", "back", "root", *discipline)

    def hurry(self) -> None:
        subprocess.run(["tc", "qdisc", "del", "dev", f"back{self.number}", "root"], check=True, capture_output=True)
        self.run("tc", "qdisc", "del", "dev", "back", "root")

    def end(self) -> None:
        for bridge in ("front", "back"):
            ip("link", "del", f"{bridge}{self.number}")
        self.holder.kill()
        self.holder.wait()


def ways_to_be_slow(tell: Callable[[str], None]) -> list[tuple[str, ...]]:
    """The queueing disciplines of this kernel that make a network slow; what it lacks is told."""
    wanted = (("netem", "delay", "80ms", "40ms"), ("netem", "loss", "5%"), ("tbf", "rate", "3mbit", "burst", "16kb", "latency", "400ms"))
    there = []
    host = Host("probe", 253)
    for words in wanted:
        try:
            host.slow(*words)
            there.append(words)
        except (OSError, subprocess.CalledProcessError):
            tell(f"A SLOW NETWORK BY {' '.join(words)} NOT TESTED: the kernel has no such queueing discipline.")
            continue
        host.hurry()
    host.end()
    return there
