"""Bad input gets a problem document that names row, column or parameter, and leaves nothing behind.

Nothing behind means: no recording, no device, no file under blobs/, columns/ or incoming/.
"""
from __future__ import annotations

import gzip
import io
import json
import lzma
import os
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import samples
from daemon import Answer, Daemon, parse_answer, read_answer
from suite import DaemonTest

TIMED = "t=time::s,gz=angular_rate:z:deg/s"


class Refused(DaemonTest):
    def setUp(self) -> None:
        self.before = self.daemon.traces()

    def tearDown(self) -> None:
        self.assertEqual(self.daemon.traces(), self.before, "something was left behind")

    def refused(self, content: bytes, status: int, code: str, *, where: dict[str, object] | None = None, says: str = "", **query: object) -> None:
        """The same fault whether the metadata stand in the query or in a part."""
        answer = self.daemon.upload(content, **{"device": "never-seen", "rate_hz": 100, **query})
        problem = self.problem(status, code, answer, **(where or {}))
        self.assertIn(says, str(problem["detail"]))
        self.assertRegex(str(problem["detail"]), r"^[A-Z'].*[.?…]$", "one sentence")

    def test_empty_file(self) -> None:
        self.refused(b"", 400, "empty_input")

    def test_header_only(self) -> None:
        self.refused(b"gx,gz\n", 422, "no_samples")
        self.refused(b"# a comment\ngx,gz\n\n", 422, "no_samples")

    def test_ragged_row(self) -> None:
        self.refused(b"gx,gz\n1,2\n3\n4,5\n", 422, "ragged_row", where={"row": 3}, says="3")
        self.refused(b"gx,gz\n1,2\n3,4,5\n", 422, "ragged_row", where={"row": 3})

    def test_text_in_a_number(self) -> None:
        self.refused(b"gx,gz\n1,2\n3,4\n5,six\n", 422, "not_a_number", where={"row": 4, "column": "gz"}, says="gz")
        self.refused(b"gx,gz\n1,2\n3,\n5,6\n", 422, "not_a_number", where={"row": 3, "column": "gz"})

    def test_nan_and_infinities(self) -> None:
        for text in (b"nan", b"NaN", b"inf", b"-inf", b"Infinity"):
            self.refused(b"gx,gz\n1,2\n" + text + b",4\n", 422, "non_finite", where={"row": 3, "column": "gx"})
        columns = samples.noise(50, 2)
        for value in (float("nan"), float("inf"), float("-inf")):
            columns[1][20] = value
            self.refused(samples.npy(columns), 422, "non_finite", where={"row": 21, "column": 1})

    def test_number_no_double_holds(self) -> None:
        self.refused(b"gz\n1\n1e400\n", 422, "out_of_range", where={"row": 3, "column": "gz"})

    def test_one_sample(self) -> None:
        self.refused(b"gz\n1\n", 422, "too_few_samples")
        self.refused(samples.npy([[1.0]]), 422, "too_few_samples")

    def test_time_that_runs_backwards(self) -> None:
        self.refused(b"t,gz\n0,1\n0.01,2\n0.005,3\n0.02,4\n", 422, "non_monotonic_time", where={"row": 3}, says="time column", columns=TIMED, rate_hz=None)

    def test_rate_missing_or_contradicted_by_the_time_column(self) -> None:
        self.refused(samples.gyro_csv(), 422, "inconsistent_sampling", where={"parameter": "rate_hz"}, rate_hz=None)
        rows = b"".join(b"%.2f,%d\n" % (i / 100, i % 7) for i in range(200))
        self.refused(b"t,gz\n" + rows, 422, "inconsistent_sampling", where={"parameter": "rate_hz"}, columns=TIMED, rate_hz=50)

    def test_unknown_words_in_the_metadata(self) -> None:
        csv = samples.gyro_csv()
        self.refused(csv, 400, "unknown_unit", where={"parameter": "columns", "column": "gz"}, says="furlong", columns="gz=angular_rate:z:furlong")
        in_the_header = b"gz [furlong]\n" + csv.partition(b"\n")[2]
        self.refused(in_the_header, 400, "unknown_unit", where={"column": "gz [furlong]"}, says="furlong")
        self.refused(csv, 400, "unknown_quantity", where={"parameter": "columns", "column": "gz"}, says="spin", columns="gz=spin:z:deg/s")
        self.refused(csv, 400, "unit_mismatch", where={"column": "gz"}, columns="gz=angular_rate:z:m/s^2")
        self.refused(csv, 400, "unknown_condition", where={"parameter": "condition"}, says="asleep", condition="asleep")
        self.refused(csv, 400, "unknown_unit", where={"parameter": "condition"}, condition="constant_rate:z:9:turns")
        self.refused(csv, 422, "unknown_column", where={"column": "nobody"}, columns="nobody=angular_rate:z:deg/s")
        self.refused(b"gz,gz\n1,2\n3,4\n", 422, "duplicate_column", where={"column": "gz"})

    def test_parameters_out_of_range(self) -> None:
        csv = samples.gyro_csv()
        for query in ({"rate_hz": 0}, {"rate_hz": -1}, {"rate_hz": "fast"}, {"rate_hz": "nan"}, {"rate_hz": "inf"}, {"trim_start_s": -1}, {"trim_end_s": "x"},
                      {"device": None}, {"device": ""}, {"device": "d" * 201}, {"condition": None}, {"columns": "gz"}, {"condition": "constant_rate", "value": "x"}):
            [name] = list(query)[-1:]
            self.refused(csv, 400, "invalid_argument", where={"parameter": name}, **query)
        self.refused(csv, 422, "too_few_samples", trim_start_s=100)

    def test_names_that_no_device_may_have(self) -> None:
        csv = samples.gyro_csv()
        ghost = "dev_" + "0" * 26  # as an id, but there is no such device
        for name in ("a\0b", "a\nb", "\x1b[31m", "\x7f", "\x85", ghost):
            with self.subTest(name=name):
                self.refused(csv, 400, "invalid_argument", where={"parameter": "device"}, device=name)
                for device in (name, {"id": name}):
                    metadata = {"device": device, "rate_hz": 100, "condition": {"kind": "static"}}
                    self.problem(400, "invalid_argument", self.daemon.upload_parts(("metadata", json.dumps(metadata).encode()), ("file", csv)), parameter="device")
                self.problem(400, "invalid_argument", self.daemon.post("/v1/devices", {"name": name}))
                study = self.daemon.post("/v1/studies", {"device": {"id": name}, "recordings": [{"recording": "rec_" + "0" * 26}]})
                self.assertEqual(study.status, 404 if name == ghost else 400, study.describe())
        # Bytes that are no UTF-8 can stand in a query alone: JSON has none.
        for bytes_ in ("%FF", "%C3", "%ED%A0%80", "a%C3b"):
            answer = self.daemon.post(f"/v1/recordings?device={bytes_}&condition=static&rate_hz=100", csv, {"Content-Type": "application/octet-stream"})
            self.problem(400, "invalid_argument", answer, parameter="device")
        self.problem(400, "parse_error", self.daemon.post("/v1/devices", b'{"name": "\xff"}', {"Content-Type": "application/json"}))

    def test_faults_of_a_metadata_part_are_all_reported(self) -> None:
        metadata = {"device": "never-seen", "rate_hz": -1, "condition": {"kind": "asleep"}, "colour": 1,
                    "columns": {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "furlong"}, "a/b": {"quantity": "spin"}}}
        answer = self.expect(400, self.daemon.upload_parts(("metadata", json.dumps(metadata).encode()), ("file", samples.gyro_csv())))
        pointers = {error["pointer"] for error in answer.json["errors"]}
        self.assertEqual(pointers, {"/rate_hz", "/condition/kind", "/colour", "/columns/gz/unit", "/columns/a~1b/quantity"})
        self.assertEqual(answer.json["where"]["part"], "metadata")

    def test_multipart_that_is_none(self) -> None:
        good = json.dumps({"device": "never-seen", "rate_hz": 100, "condition": {"kind": "static"}}).encode()
        csv = samples.gyro_csv()
        for code, parts, part in (("invalid_argument", [("metadata", good)], "file"),
                                  ("invalid_argument", [("file", csv), ("metadata", good), ("file", csv)], "file"),
                                  ("invalid_argument", [("file", csv), ("notes", b"x"), ("metadata", good)], "notes"),
                                  ("parse_error", [("file", csv), ("metadata", b"{")], "metadata")):
            self.problem(400, code, self.daemon.upload_parts(*parts), part=part)
        form = {"Content-Type": "multipart/form-data; boundary=b"}
        target = "/v1/recordings?device=never-seen&condition=static"
        self.problem(422, "truncated", self.daemon.post(target, b'--b\r\nContent-Disposition: form-data; name="file"\r\n\r\n' + csv, form))
        self.problem(400, "parse_error", self.daemon.post(target, b"--b\r\n\r\n" + csv + b"\r\n--b--\r\n", form))
        self.problem(400, "parse_error", self.daemon.post(target, b"--b\r\nX: " + b"y" * 9000 + b"\r\n\r\n", form))
        self.problem(400, "parse_error", self.daemon.post(target, csv, {"Content-Type": "multipart/form-data"}))
        huge = self.daemon.upload_parts(("metadata", b" " * (1 << 21)), ("file", csv))
        self.problem(413, "limit_exceeded", huge, part="metadata")

    def test_truncated_npy(self) -> None:
        whole = samples.npy(samples.noise(500, 2))
        for size in (9, 40, 127, 128, len(whole) // 2, len(whole) - 1):
            self.refused(whole[:size], 422, "truncated")

    def test_npy_whose_header_lies(self) -> None:
        columns = samples.noise(100, 2)
        self.refused(samples.npy(columns, shape="(101, 2)"), 422, "truncated")
        self.refused(samples.npy(columns, shape="(99, 2)"), 422, "shape_mismatch")
        for shape in ("(0, 2)", "(100, 0)", "(100, 2, 1)", "(-100, -2)", "(9223372036854775807, 2)", "(4611686018427387904, 4)", "(100, 2", "100"):
            answer = self.daemon.upload(samples.npy(columns, shape=shape), device="never-seen", rate_hz=100)
            self.assertIn(answer.status, (413, 415, 422), f"{shape}: {answer.describe()}")
        for kind in ("<M8", "<c16", "|O", ">f16"):
            answer = self.daemon.upload(samples.npy(columns, kind=kind), device="never-seen", rate_hz=100)
            self.problem(415, "unsupported_type", answer)

    def test_compressed_stream_that_is_damaged(self) -> None:
        for name in ("gzip", "xz", "zstd"):
            packed = samples.COMPRESSIONS[name](samples.gyro_csv(5000))
            self.refused(packed[:len(packed) // 2], 422, "truncated")
            middle = bytearray(packed)
            middle[len(packed) // 2] ^= 0xff
            answer = self.daemon.upload(bytes(middle), device="never-seen", rate_hz=100)
            self.assertEqual(answer.status, 422, f"{name}: {answer.describe()}")  # zstd without a checksum may yield other text

    def test_bombs(self) -> None:
        """A small stream that expands without end is given up, as text and as numbers."""
        zeros = bytes(1 << 20)
        header = samples.npy([[0.0]], shape=f"({1 << 30},)", flat=True)[:128]
        packed = io.BytesIO()
        with gzip.GzipFile(fileobj=packed, mode="wb", compresslevel=9, mtime=0) as stream:
            stream.write(header)
            for _ in range(360):
                stream.write(zeros)
        started = time.monotonic()
        self.refused(packed.getvalue(), 413, "decompression_limit")
        rows = b"0\n" * (1 << 19)
        compressor = lzma.LZMACompressor(preset=0)
        text = compressor.compress(b"gz\n") + b"".join(compressor.compress(rows) for _ in range(360)) + compressor.flush()
        self.refused(text, 413, "decompression_limit")
        self.refused(gzip.compress(b"gz\n" + b"1" * (64 << 20), 1), 413, "limit_exceeded")
        self.refused(gzip.compress(gzip.compress(samples.gyro_csv())), 415, "unsupported_format")
        self.assertLess(self.daemon.memory_kib("VmHWM"), 512 * 1024 * (4 if os.environ.get("DRIFTLAB_SANITIZE") else 1))
        self.assertLess(time.monotonic() - started, 60)

    def test_foreign_formats_are_named(self) -> None:
        for content in (b"\x89PNG\r\n\x1a\n" + bytes(99), b"PK\x03\x04" + bytes(99), b"\x7fELF" + bytes(99)):
            self.refused(content, 415, "unsupported_format")
        self.refused(b"SQLite format 3\0" + bytes(99), 422, "shape_mismatch")  # read as a ROS 2 bag, which it is not
        self.assertGreaterEqual(self.daemon.upload(os.urandom(4096), device="never-seen", rate_hz=100).status, 400)
        self.assertGreaterEqual(self.daemon.upload(b"hello\nworld\n", device="never-seen", rate_hz=100).status, 400)

    def test_limits_of_text(self) -> None:
        self.refused(b"gz\n" + b"1" * (1 << 21) + b"\n", 413, "limit_exceeded")
        names = b",".join(b"c%d" % i for i in range(1025))
        self.refused(names + b"\n" + b",".join([b"1"] * 1025) + b"\n", 413, "limit_exceeded")


class Survived(DaemonTest):
    """What real recordings have in them is reported, not refused, while it is little: the analysis leaves it out."""

    def quality(self, content: bytes, **query: object) -> dict:
        recording = self.expect(201, self.daemon.upload(content, device="survivor", **{"rate_hz": 100, **query}))
        return recording.json["quality"]

    def test_few_holes(self) -> None:
        values = ["%.4f" % (0.01 * ((i * 7919) % 1009)) for i in range(5000)]
        values[100] = "nan"
        values[200] = ""
        values[300] = "-9999"
        rows = "".join(f"{value},S\n" for value in values).encode()
        [channel] = self.quality(b"gz,state\n" + rows)["channels"]
        self.assertEqual((channel["missing"], channel["implausible"], channel["first"], channel["analysed"]), (2, 1, 1, 4997))

    def test_clock_set_back_and_counter_that_starts_again(self) -> None:
        def table(stamps: list[int]) -> bytes:
            return b"t,gz\n" + b"".join(b"%d,%d\n" % (t, (i * 31) % 17) for i, t in enumerate(stamps))
        columns = "t=time::ms,gz=angular_rate:z:deg/s"
        quality = self.quality(table([10 * i - (1000 if i >= 3000 else 0) for i in range(5000)]), columns=columns, rate_hz=None)
        self.assertEqual((quality["backward_steps"], quality["analysed"]), (1, 3000))
        quality = self.quality(table([(10 * i + 60000) % 65536 for i in range(5000)]), columns=columns, rate_hz=None)
        self.assertEqual((quality["counter_wraps"], quality["backward_steps"], quality["analysed"]), (1, 0, 5000))

    def test_dialects(self) -> None:
        rows = b"".join(b"%d,%02d;%d,5E-1\r\n" % (i // 100, i % 100, i % 7) for i in range(500))
        quality = self.quality(b'\xef\xbb\xbf"Time (s)";"Z (rad/s)"\r\n' + rows, rate_hz=None)
        self.assertEqual((quality["samples"], round(quality["measured_rate_hz"], 6)), (500, 100))


class Interrupted(DaemonTest):
    """Lengths that lie and clients that leave."""

    TARGET = "/v1/recordings?device=never-seen&condition=static&rate_hz=100"

    def setUp(self) -> None:
        self.before = self.daemon.traces()

    def tearDown(self) -> None:
        until = time.monotonic() + 20
        while self.daemon.traces() != self.before and time.monotonic() < until:
            time.sleep(0.02)
        self.assertEqual(self.daemon.traces(), self.before, "something was left behind")

    def head(self, length: object) -> bytes:
        return f"POST {self.TARGET} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {length}\r\n\r\n".encode()

    def answer(self, text: bytes) -> Answer:
        answer = parse_answer(self.daemon.exchange(text), "POST", self.TARGET)
        self.contract.judge(answer)
        return answer

    def test_fewer_bytes_than_declared(self) -> None:
        content = samples.gyro_csv()
        with self.daemon.connect() as connection:
            connection.sendall(self.head(len(content) + 1) + content)
            connection.shutdown(1)
            answer = read_answer(connection, "POST", self.TARGET)
        self.contract.judge(answer)
        self.problem(400, "incomplete_body", answer)

    def test_more_bytes_than_declared(self) -> None:
        content = samples.gyro_csv()
        for cut in (len(content) // 2, len(content) - 1, len(content) - 20):
            self.problem(400, "bad_request", self.answer(self.head(cut) + content))

    def test_lengths_that_are_none(self) -> None:
        for length in ("-1", "x", "1e3", "", "99999999999999999999"):
            self.expect(400, self.answer(self.head(length) + b"gz\n1\n2\n"))
        self.problem(413, "body_too_large", self.answer(self.head(9 << 30)))
        self.problem(411, "length_required", self.answer(f"POST {self.TARGET} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()))

    def test_client_gone_half_way(self) -> None:
        content = samples.npy(samples.noise(60_000))
        for abrupt in (False, True):
            earlier = self.daemon.files("incoming")  # what a client left a moment ago may still lie there
            with self.daemon.connect() as connection:
                connection.sendall(self.head(len(content)) + content[:len(content) // 2])
                until = time.monotonic() + 20
                while not (begun := set(self.daemon.files("incoming")) - set(earlier)) and time.monotonic() < until:
                    time.sleep(0.005)
                self.assertTrue(begun, "the upload has not begun")
                if abrupt:  # RST instead of FIN
                    connection.setsockopt(1, 13, b"\x01\0\0\0\0\0\0\0")
        self.expect(200, self.daemon.get("/healthz"))


class DiskFull(unittest.TestCase):
    def full(self, daemon: Daemon, content: bytes) -> None:
        before = daemon.traces()
        answer = daemon.upload(content, rate_hz=100, columns="0=angular_rate:z:deg/s")
        self.assertEqual((answer.status, answer.json["code"]), (507, "disk_full"), answer.describe())
        self.assertTrue(answer.json["retryable"])
        self.assertEqual(daemon.traces(), before)
        # What fits still goes in, and the daemon does its work.
        recording = daemon.upload(samples.gyro_csv(), rate_hz=100, columns=samples.GYRO_Z)
        self.assertEqual(recording.status, 201, recording.describe())
        job = daemon.finished(daemon.characterise(recording.json["id"], models=["WN"]).json["id"])
        self.assertEqual(job["state"], "succeeded", job)

    @unittest.skipIf("thread" in os.environ.get("DRIFTLAB_SANITIZE", ""), "the sanitizer writes files of its own")
    def test_file_that_may_not_grow(self) -> None:
        """RLIMIT_FSIZE: write() fails with EFBIG at 8 MiB, in the bytes themselves and in the decoded columns."""
        def limit() -> None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (8 << 20, 8 << 20))
        column = samples.noise(1 << 16)[0] * 20  # 10 MiB as doubles
        for content in (samples.npy([column]), samples.COMPRESSIONS["zstd"](samples.npy([column]))):
            with Daemon(before_exec=limit) as daemon:
                self.full(daemon, content)

    def test_file_system_that_is_full(self) -> None:
        """ENOSPC on a tmpfs, where this may be mounted."""
        folder = Path(tempfile.mkdtemp(prefix="driftlab-full-"))
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=80m", "tmpfs", str(folder)], capture_output=True, check=False).returncode == 0
        try:
            if not mounted:
                print("SKIPPED: a full file system, for no tmpfs can be mounted here (root alone may)")
                self.skipTest("no tmpfs can be mounted here")
            with Daemon(folder / "data", arguments=("--budget", "least_free_bytes=1000000", "--budget", "reserve_bytes=1000000")) as daemon:
                self.full(daemon, samples.npy([samples.noise(1 << 16)[0] * 100]))  # 50 MiB and its columns: more than 80
        finally:
            if mounted:
                subprocess.run(["umount", "-l", str(folder)], check=False)
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    unittest.main()
