"""OpenStack Swift with its S3 interface in one process, in a folder, on loopback: swift_server.py FOLDER.

Debian's package python3-swift, run by Debian's Python; no service, no memcached, no user of its own. It writes its port to FOLDER/port once it answers. tests/api/object_storage.py starts it.
"""
# No annotations that are evaluated, no import before the patch: eventlet goes first.
import eventlet

eventlet.patcher.monkey_patch(thread=False)

import ctypes  # noqa: E402
import logging  # noqa: E402
import signal  # noqa: E402
import sys  # noqa: E402
import time  # noqa: E402
from pathlib import Path  # noqa: E402
from time import monotonic  # noqa: E402

import eventlet.wsgi  # noqa: E402
from swift.common import constraints, storage_policy, utils  # noqa: E402

PR_SET_PDEATHSIG = 1
USER, KEY = "lab:driftlab", "a-secret-of-the-tests"
PIPELINE = "catch_errors gatekeeper healthcheck listing_formats bulk s3api tempauth container_quotas slo proxy-server"
PROXY = """
[DEFAULT]
bind_ip = 127.0.0.1
bind_port = 0
swift_dir = {folder}
[pipeline:main]
pipeline = {pipeline}
[app:proxy-server]
use = egg:swift#proxy
account_autocreate = true
allow_account_management = true
[filter:tempauth]
use = egg:swift#tempauth
user_lab_driftlab = {key} .admin
user_lab_stranger = {key}
[filter:s3api]
use = egg:swift#s3api
location = test-region
min_segment_size = 1
[filter:slo]
use = egg:swift#slo
[filter:container_quotas]
use = egg:swift#container_quotas
[filter:bulk]
use = egg:swift#bulk
[filter:listing_formats]
use = egg:swift#listing_formats
[filter:gatekeeper]
use = egg:swift#gatekeeper
[filter:catch_errors]
use = egg:swift#catch_errors
[filter:healthcheck]
use = egg:swift#healthcheck
"""
SERVER = """
[DEFAULT]
bind_ip = 127.0.0.1
bind_port = 0
swift_dir = {folder}
devices = {folder}/devices
mount_check = false
fallocate_reserve = 0
disable_fallocate = true
[pipeline:main]
pipeline = {kind}-server
[app:{kind}-server]
use = egg:swift#{kind}
"""


class Memory:
    """What memcached is for Swift, as far as one process asks for it."""

    def __init__(self) -> None:
        self.kept: dict = {}

    def get(self, key, raise_on_error=False):  # noqa: ANN001, ANN201
        value, until = self.kept.get(key, (None, 0.0))
        return value if until > monotonic() else None

    def set(self, key, value, serialize=True, time=0, min_compress_len=0, raise_on_error=False):  # noqa: ANN001, ANN201
        self.kept[key] = (value, monotonic() + (time or 3600))

    def incr(self, key, delta=1, time=0):  # noqa: ANN001, ANN201
        value = int(self.get(key) or 0) + delta
        self.set(key, value, time=time)
        return value

    def delete(self, key, server_key=None):  # noqa: ANN001, ANN201
        self.kept.pop(key, None)


def remembering(app):  # noqa: ANN001, ANN201
    memory = Memory()

    def answer(environ, start_response):  # noqa: ANN001, ANN202
        environ["swift.cache"] = memory
        return app(environ, start_response)

    return answer


def configure(folder: Path) -> None:
    """What packages keep in /etc/swift."""
    conf = folder / "swift.conf"
    conf.write_text("[swift-hash]\nswift_hash_path_prefix = driftlab\nswift_hash_path_suffix = tests\n"
                    "[storage-policy:0]\nname = only\ndefault = yes\n")
    utils.SWIFT_CONF_FILE = str(conf)
    utils.HASH_PATH_PREFIX, utils.HASH_PATH_SUFFIX = b"driftlab", b"tests"
    storage_policy.reload_storage_policies()
    constraints.reload_constraints()


def write_ring(folder: Path, name: str, port: int) -> None:
    from swift.common.ring import RingBuilder

    builder = RingBuilder(part_power=2, replicas=1, min_part_hours=0)
    builder.add_dev({"id": 0, "region": 1, "zone": 1, "ip": "127.0.0.1", "port": port, "device": "disk", "weight": 1.0,
                     "replication_ip": "127.0.0.1", "replication_port": port, "meta": ""})
    builder.rebalance()
    builder.get_ring().save(str(folder / f"{name}.ring.gz"))


def main() -> None:
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    folder = Path(sys.argv[1])
    (folder / "devices" / "disk").mkdir(parents=True, exist_ok=True)
    configure(folder)
    from swift.common.wsgi import SwiftHttpProtocol, loadapp

    logging.basicConfig(filename=folder / "log", level=logging.WARNING)
    quiet = logging.getLogger("driftlab")
    sockets = {name: eventlet.listen(("127.0.0.1", 0)) for name in ("account", "container", "object", "proxy")}
    for name in ("account", "container", "object"):
        write_ring(folder, name, sockets[name].getsockname()[1])
    for name, listening in sockets.items():
        text = PROXY.format(folder=folder, pipeline=PIPELINE, key=KEY) if name == "proxy" else SERVER.format(folder=folder, kind=name)
        conf = folder / f"{name}.conf"
        conf.write_text(text)
        app = loadapp(str(conf), global_conf={})
        eventlet.spawn(eventlet.wsgi.server, listening, remembering(app) if name == "proxy" else app, quiet, protocol=SwiftHttpProtocol,
                       log_output=False, custom_pool=eventlet.GreenPool(200))
    eventlet.sleep(0)
    (folder / "port.part").write_text(str(sockets["proxy"].getsockname()[1]))
    (folder / "port.part").rename(folder / "port")
    while True:
        eventlet.sleep(3600)


if __name__ == "__main__":
    time.tzset()
    main()
