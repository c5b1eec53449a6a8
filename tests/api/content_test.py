"""The uploaded file back: whole, in parts, under a safe name."""
from __future__ import annotations

import hashlib
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import samples
from suite import DaemonTest


class Content(DaemonTest):
    def uploaded(self, content: bytes, **query: str | float) -> str:
        return str(self.expect(201, self.daemon.upload(content, **{"rate_hz": 100, **query})).headers["location"]) + "/content"

    def test_every_container_comes_back_as_it_was_sent(self) -> None:
        plain = samples.gyro_csv(20_000, seed=1)
        for compression, compress in samples.COMPRESSIONS.items():
            packed = compress(plain)
            target = self.uploaded(packed, device=compression)
            answer = self.expect(200, self.daemon.get(target))
            self.assertEqual(answer.body, packed)
            self.assertEqual(answer.headers["etag"], f'"{hashlib.sha256(packed).hexdigest()}"')
            self.assertEqual(answer.headers["accept-ranges"], "bytes")
            self.assertEqual(answer.headers["content-type"], "application/octet-stream")
            self.assertIn("immutable", answer.headers["cache-control"])
            self.assertNotIn("content-encoding", answer.headers)
            packed_too = self.expect(200, self.daemon.get(target, Accept_Encoding="gzip"))
            self.assertEqual(packed_too.body, packed)

    def test_parts(self) -> None:
        content = samples.gyro_csv(200_000, seed=2)  # several pieces of 256 KiB
        target = self.uploaded(content)
        size = len(content)
        self.assertGreater(size, 3 << 18)
        for asked, first, last in (("0-0", 0, 0), ("5-99", 5, 99), (f"{size - 10}-", size - 10, size - 1), ("-7", size - 7, size - 1),
                                   ("100000-900000", 100000, 900000), ("0-", 0, size - 1), (f"3-{size * 2}", 3, size - 1)):
            answer = self.expect(206, self.daemon.get(target, Range=f"bytes={asked}"))
            self.assertEqual(answer.body, content[first:last + 1], asked)
            self.assertEqual(answer.headers["content-range"], f"bytes {first}-{last}/{size}")
        for asked in ("bytes=0-1,4-5", "lines=1-2", "bytes=9-1"):
            self.assertEqual(self.expect(200, self.daemon.get(target, Range=asked)).body, content)
        refused = self.daemon.get(target, Range=f"bytes={size}-")
        self.problem(416, "range_not_satisfiable", refused)
        self.assertEqual(refused.headers["content-range"], f"bytes */{size}")

    def test_conditions(self) -> None:
        content = samples.gyro_csv(seed=3)
        target = self.uploaded(content)
        etag = self.daemon.get(target).headers["etag"]
        for headers in ({"If-None-Match": etag}, {"If-None-Match": etag, "Range": "bytes=0-9"}):
            answer = self.expect(304, self.daemon.request("GET", target, headers=headers))
            self.assertEqual((answer.body, answer.headers["etag"]), (b"", etag))
        for tag, status in ((etag, 206), ('"other"', 200)):
            self.expect(status, self.daemon.request("GET", target, headers={"If-Range": tag, "Range": "bytes=0-9"}))
        head = self.expect(200, self.daemon.request("HEAD", target, headers={"Range": "bytes=0-9"}))
        self.assertEqual((head.body, head.headers["content-length"]), (b"", str(len(content))))
        self.problem(404, "not_found", self.daemon.get("/v1/recordings/rec_nobody/content"))

    def test_the_name_is_safe(self) -> None:
        names = {"rate-9 run/1": "rate-9_run_1.csv", "../../etc/passwd": None, 'a"\r\nX-Evil: 1': None, "-rf": None, "\u00e9\u4e16": None, "run.csv": "run.csv", "": None}
        for number, (name, expected) in enumerate(names.items()):
            target = self.uploaded(samples.gyro_csv(64, seed=100 + number), id=name)
            answer = self.expect(200, self.daemon.get(target))
            self.assertNotIn("x-evil", answer.headers)
            found = re.fullmatch(r'attachment; filename="([A-Za-z0-9_][A-Za-z0-9._-]*\.csv)"', answer.headers["content-disposition"])
            self.assertTrue(found, answer.headers["content-disposition"])
            if found and expected:
                self.assertEqual(found.group(1), expected)

    def test_curl_resumes_a_download(self) -> None:
        content = samples.gyro_csv(100_000, seed=4)
        target = f"http://127.0.0.1:{self.daemon.port}{self.uploaded(content)}"
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "part.csv")
            path.write_bytes(content[:12345])
            subprocess.run(["curl", "--silent", "--show-error", "--fail", "--noproxy", "*", "--continue-at", "-", "--output", str(path), target], check=True)
            self.assertEqual(path.read_bytes(), content)

    def test_a_damaged_file_is_said_to_be_damaged(self) -> None:
        content = samples.gyro_csv(seed=5)
        target = self.uploaded(content)
        sha256 = hashlib.sha256(content).hexdigest()
        (self.daemon.data / "blobs" / sha256[:2] / sha256).write_bytes(content[:-1])
        self.assertIn("uploading it again", str(self.problem(500, "io", self.daemon.get(target))["detail"]))


if __name__ == "__main__":
    unittest.main()
