"""One address for several daemons, as a Kubernetes Service is: connections go to those that say they are ready, in turns."""
from __future__ import annotations

import contextlib
import http.client
import socket
import threading
import time
from collections.abc import Callable

from daemon import Daemon

LOOK_S = 0.1  # between two looks at a daemon's readiness; a daemon that stops says so for half a second
PIECE = 1 << 16


class Service:
    """A context manager. `daemons`: those that may be there."""

    def __init__(self, daemons: Callable[[], list[Daemon]]) -> None:
        self._daemons = daemons
        self._ready: list[int] = []
        self._turn = 0
        self._over = threading.Event()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"http://127.0.0.1:{self._listener.getsockname()[1]}"
        self._threads = [threading.Thread(target=work, daemon=True) for work in (self._look, self._accept)]

    def __enter__(self) -> Service:
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *unused: object) -> None:
        self._over.set()
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)  # wakes who waits in accept
        self._listener.close()
        for thread in self._threads:
            thread.join()

    def _look(self) -> None:
        while not self._over.wait(LOOK_S):
            self._ready = [daemon.port for daemon in self._daemons() if is_ready(daemon.port)]

    def _accept(self) -> None:
        while not self._over.is_set():
            try:
                client, _ = self._listener.accept()
            except OSError:
                return
            threading.Thread(target=self._carry, args=(client,), daemon=True).start()

    def _carry(self, client: socket.socket) -> None:
        with client:
            ready = list(self._ready)
            self._turn += 1
            for i in range(len(ready)):
                with contextlib.suppress(OSError):
                    server = socket.create_connection(("127.0.0.1", ready[(self._turn + i) % len(ready)]))
                    break
            else:
                return
            with server:
                back = threading.Thread(target=pump, args=(server, client), daemon=True)
                back.start()
                pump(client, server)
                back.join()


def pump(source: socket.socket, target: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while piece := source.recv(PIECE):
            target.sendall(piece)
    with contextlib.suppress(OSError):
        target.shutdown(socket.SHUT_WR)


def is_ready(port: int) -> bool:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=2.0)
    try:
        connection.request("GET", "/readyz")
        return connection.getresponse().status == 200
    except (OSError, http.client.HTTPException):
        return False
    finally:
        connection.close()


def wait_until_ready(daemon: Daemon, seconds: float = 60.0) -> None:
    until = time.monotonic() + seconds
    while not is_ready(daemon.port):
        assert time.monotonic() < until, daemon.log[-3:]
        time.sleep(0.02)
