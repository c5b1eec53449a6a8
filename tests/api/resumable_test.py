"""Uploads that stop and go on (tus 1.0.0), through broken connections, lying checksums and a daemon that dies."""
from __future__ import annotations

import base64
import gzip
import hashlib
import os
import tempfile
import time
import unittest
from pathlib import Path

import samples
from daemon import PATIENCE_S, Answer, Daemon, read_answer
from suite import DaemonTest

TUS = {"Tus-Resumable": "1.0.0"}
PIECE = {**TUS, "Content-Type": "application/offset+octet-stream"}
META = "device=phone-07&condition=static&rate_hz=100&columns=gz%3Dangular_rate%3Az%3Adeg%2Fs"


class Resumable(DaemonTest):
    def begin(self, content: bytes) -> str:
        name = base64.b64encode("bench run.csv".encode()).decode()
        headers = {**TUS, "Upload-Length": str(len(content)), "Upload-Metadata": f"kind YQ==,filename {name}"}
        made = self.expect(201, self.daemon.request("POST", "/v1/uploads", headers=headers))
        self.assertEqual((made.json["file_name"], made.json["offset"], made.headers["upload-offset"]), ("bench run.csv", 0, "0"))
        return made.headers["location"]

    def put(self, upload: str, offset: int, piece: bytes, **more: str) -> Answer:
        headers = {**PIECE, "Upload-Offset": str(offset), **{name.replace("_", "-"): value for name, value in more.items()}}
        return self.daemon.request("PATCH", upload, piece, headers)

    def test_pieces_become_the_recording_that_one_request_makes(self) -> None:
        content = samples.gyro_csv(seed=3)
        upload = self.begin(content)
        half = len(content) // 2
        self.assertEqual(self.expect(204, self.put(upload, 0, content[:half])).headers["upload-offset"], str(half))
        head = self.expect(200, self.daemon.request("HEAD", upload, headers=TUS))
        self.assertEqual((head.headers["upload-offset"], head.headers["upload-length"], head.headers["tus-resumable"]),
                         (str(half), str(len(content)), "1.0.0"))
        early = self.problem(409, "conflict", self.daemon.request("POST", f"{upload}/recording?{META}"))
        self.assertIn(f"{half} of its {len(content)} bytes", str(early["detail"]))
        self.expect(204, self.put(upload, half, content[half:]))
        # Refused metadata cost nothing: the bytes stay for the next try.
        self.problem(422, "inconsistent_sampling", self.daemon.request("POST", f"{upload}/recording?device=phone-07&condition=static"))
        made = self.expect(201, self.daemon.request("POST", f"{upload}/recording?{META}"))
        at_once = self.expect(200, self.daemon.upload(content, rate_hz=100, columns=samples.GYRO_Z))
        self.assertEqual(made.json["id"], at_once.json["id"])
        self.problem(404, "not_found", self.daemon.get(upload))

    def test_nothing_prompt_waits_while_they_are_decoded(self) -> None:
        """Four small files that become much had every thread of the handlers: /readyz answered after 13 s."""
        ready = []
        for i in range(5):
            content = gzip.compress(b"gz\n" + b"0.%d\n" % (i + 1) * 3_000_000, 1)
            ready.append(self.begin(content))
            self.expect(204, self.put(ready[-1], 0, content))
        self.is_prompt_beside([lambda upload=upload: self.daemon.request("POST", f"{upload}/recording?{META}") for upload in ready], 201)

    def test_what_nobody_goes_on_with_for_a_day_is_forgotten(self) -> None:
        content = samples.gyro_csv(seed=12)
        upload = self.begin(content)
        self.expect(204, self.put(upload, 0, content[:500]))
        state = self.expect(200, self.daemon.get(upload)).json
        [part] = (self.daemon.data / "uploads").rglob(f"{state['id']}*.part")
        changed = part.stat().st_mtime
        os.utime(part, (changed, changed - 23 * 3600))
        self.assertEqual(self.expect(200, self.daemon.get(upload)).json["offset"], 500, "a day has not passed")
        os.utime(part, (changed, changed - 25 * 3600))
        self.problem(404, "not_found", self.daemon.get(upload))
        self.assertEqual(self.daemon.request("HEAD", upload, headers=TUS).status, 404)
        self.assertEqual(self.put(upload, 500, content[500:]).status, 404)
        self.assertTrue(part.exists(), "it is removed with the next upload that begins, or within an hour")
        other = self.begin(content)
        self.assertFalse(part.exists())
        self.assertEqual(list(part.parent.glob(f"{state['id']}*")), [])
        self.expect(204, self.put(other, 0, content))

    def test_what_arrived_before_a_connection_broke_is_kept(self) -> None:
        content = samples.gyro_csv(seed=4)
        upload = self.begin(content)
        head = (f"PATCH {upload} HTTP/1.1\r\nHost: 127.0.0.1:{self.daemon.port}\r\nTus-Resumable: 1.0.0\r\nUpload-Offset: 0\r\n"
                f"Content-Type: application/offset+octet-stream\r\nContent-Length: {len(content)}\r\n\r\n").encode()
        with self.daemon.connect() as connection:
            connection.sendall(head + content[:1000])
            connection.shutdown(1)  # and nothing more
            read_answer(connection)
        state = self.expect(200, self.daemon.get(upload)).json
        self.assertEqual(state["offset"], 1000)
        self.expect(204, self.put(upload, 1000, content[1000:]))
        self.expect(201, self.daemon.request("POST", f"{upload}/recording?{META}"))

    def test_a_piece_with_a_wrong_checksum_is_taken_back(self) -> None:
        content = samples.gyro_csv(seed=5)
        upload = self.begin(content)

        def stated(method: str, piece: bytes) -> str:
            return f"{method} " + base64.b64encode(hashlib.new(method, piece).digest()).decode()
        self.problem(460, "checksum_mismatch", self.put(upload, 0, content[:500], Upload_Checksum=stated("sha256", content[:499])))
        self.assertEqual(self.daemon.get(upload).json["offset"], 0)
        self.expect(204, self.put(upload, 0, content[:500], Upload_Checksum=stated("sha1", content[:500])))
        self.expect(204, self.put(upload, 500, content[500:], Upload_Checksum=stated("sha256", content[500:])))
        self.problem(400, "invalid_argument", self.put(upload, 0, b"x", Upload_Checksum="md5 AAAA"), parameter="Upload-Checksum")

    def test_every_misuse_is_a_sentence(self) -> None:
        content = b"gz\n" + b"1\n" * 100
        upload = self.begin(content)
        self.problem(409, "conflict", self.put(upload, 7, b"x"), offset=0)
        self.problem(412, "precondition_failed", self.daemon.request("PATCH", upload, b"x", {"Upload-Offset": "0", "Content-Type": PIECE["Content-Type"]}))
        self.problem(415, "unsupported_media_type", self.daemon.request("PATCH", upload, b"x", {**TUS, "Upload-Offset": "0", "Content-Type": "text/csv"}))
        self.problem(400, "invalid_argument", self.daemon.request("PATCH", upload, b"x", PIECE), parameter="Upload-Offset")
        self.problem(400, "invalid_argument", self.put(upload, 0, content + b"x"), parameter="Content-Length")
        self.problem(412, "precondition_failed", self.daemon.request("POST", "/v1/uploads", headers={"Upload-Length": "5"}))
        for length in ("", "0", "-1", "x"):
            self.problem(400, "invalid_argument", self.daemon.request("POST", "/v1/uploads", headers={**TUS, "Upload-Length": length}), parameter="Upload-Length")
        self.problem(413, "body_too_large", self.daemon.request("POST", "/v1/uploads", headers={**TUS, "Upload-Length": str((8 << 30) + 1)}))
        self.expect(204, self.daemon.request("DELETE", upload, headers=TUS))
        for id in (upload.rpartition("/")[2], "upl_nobody", "..", "upl_..%5C..%5Cdriftlab.db.xxxxxxxxx"):
            self.problem(404, "not_found", self.daemon.get(f"/v1/uploads/{id}"))


class Restart(unittest.TestCase):
    def test_what_was_forgotten_goes_without_another_upload(self) -> None:
        folder = self.enterContext(tempfile.TemporaryDirectory())
        with Daemon(Path(folder)) as daemon:
            old, young = (daemon.request("POST", "/v1/uploads", headers={**TUS, "Upload-Length": "100"}).json["id"] for _ in range(2))
        kept = Path(folder) / "uploads"
        day_ago = time.time() - 25 * 3600
        os.utime(kept / f"{old}.part", (day_ago, day_ago))
        with Daemon(Path(folder)):
            until = time.monotonic() + PATIENCE_S
            while (kept / f"{old}.part").exists() and time.monotonic() < until:
                time.sleep(0.05)
            self.assertEqual(sorted(path.name for path in kept.iterdir()), [f"{young}.about", f"{young}.part"])

    def test_an_upload_goes_on_after_the_daemon_was_killed(self) -> None:
        """What was acknowledged is on the disk: a daemon that dies and comes back stands at the same offset."""
        content = samples.gyro_csv(seed=6)
        folder = self.enterContext(tempfile.TemporaryDirectory())  # removed last, when no daemon writes into it
        daemon = self.enterContext(Daemon(Path(folder)))
        headers = {**TUS, "Upload-Length": str(len(content))}
        upload = daemon.request("POST", "/v1/uploads", headers=headers).headers["location"]
        daemon.request("PATCH", upload, content[:3000], {**PIECE, "Upload-Offset": "0"})
        daemon.kill()
        daemon = self.enterContext(Daemon(Path(folder)))
        self.assertEqual(daemon.get(upload).json["offset"], 3000)
        daemon.request("PATCH", upload, content[3000:], {**PIECE, "Upload-Offset": "3000"})
        self.assertEqual(daemon.request("POST", f"{upload}/recording?{META}").status, 201)


if __name__ == "__main__":
    unittest.main()
