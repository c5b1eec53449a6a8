"""What a file would be, told from its first bytes: columns, rate, condition, problems; and that nothing of it is kept."""
from __future__ import annotations

import gzip
import math
import unittest
from typing import Any

import samples
from suite import DaemonTest


class Preview(DaemonTest):
    def preview(self, content: bytes, query: str = "", of: int | None = None) -> dict[str, Any]:
        headers = {"Content-Type": "application/octet-stream"}
        if of is not None:
            headers["Content-Range"] = f"bytes 0-{len(content) - 1}/{of}"
        return dict(self.expect(200, self.daemon.request("POST", "/v1/recordings/preview" + query, content, headers)).json)

    def turning(self, rows: int = 400) -> bytes:
        noise = samples.noise(rows, seed=11)[0]
        lines = [f"{i * 0.01:.2f},{9 + 0.05 * value:.4f},{20 + i % 3}" for i, value in enumerate(noise)]
        return ("time [s],gz [deg/s],temp [degC]\n" + "\n".join(lines) + "\n").encode()

    def test_columns_rate_and_condition_are_told_and_nothing_is_kept(self) -> None:
        content = self.turning()
        found = self.preview(content, of=len(content))
        self.assertEqual((found["format"], found["compression"], found["whole_file"], found["rows_seen"]), ("csv", "none", True, 400))
        self.assertEqual([(c["quantity"], c["axis"], c["unit"], c["from"]) for c in found["columns"]],
                         [("time", None, "s", "header"), ("angular_rate", "z", "deg/s", "header"), ("temperature", None, "degC", "header")])
        self.assertEqual(found["columns"][2]["first"], [20, 21, 22, 20, 21])
        self.assertEqual(len(found["columns"][1]["course"]), 100)
        self.assertEqual(found["rate_hz"]["from"], "time_column")
        self.assertAlmostEqual(found["rate_hz"]["value"], 100, delta=1e-6)
        self.assertEqual(found["condition_guess"]["text"], "constant_rate:z:9:deg/s")
        self.assertEqual((found["problems"], found["time_guess"]), ([], None))
        self.assertEqual((self.daemon.items("/v1/recordings"), self.daemon.items("/v1/devices")), ([], []))

    def test_counts_are_seen_in_the_unit_that_their_scale_and_offset_make(self) -> None:
        counts = samples.noise(400, seed=12)[0]
        content = ("gz,temp\n" + "\n".join(f"{1179 + 7 * value:.0f},{-3000 + i % 3}" for i, value in enumerate(counts)) + "\n").encode()
        asked = "?rate_hz=100&condition=static&columns=gz=angular_rate:z:deg/s/131,temp=temperature::degC/340%2B36.53"
        found = self.preview(content, asked)
        self.assertEqual([c["unit"] for c in found["columns"]], ["deg/s/131", "degC/340+36.53"])
        self.assertEqual(found["condition_guess"]["text"], "constant_rate:z:9:deg/s")
        self.assertEqual(self.preview(content, asked.replace("%2B", "+"))["columns"][1]["unit"], "degC/340+36.53")
        problem = self.problem(400, "unknown_unit", self.daemon.request(
            "POST", "/v1/recordings/preview?columns=temp=temperature::degC/0", content, {"Content-Type": "application/octet-stream"}))
        self.assertIn("must be a positive number; write", str(problem["detail"]))

    def test_a_refusal_is_known_before_the_file_has_gone(self) -> None:
        """The same sentence and the same field as the upload's, and no more once the rate is said."""
        content = samples.gyro_csv(seed=3)
        (problem,) = self.preview(content, "?condition=static")["problems"]
        refused = self.daemon.upload(content)
        self.assertEqual((problem["code"], problem["detail"]), (refused.json["code"], refused.json["detail"]))
        self.assertEqual(problem["fields"].get("parameter"), "rate_hz")
        stated = self.preview(content, "?condition=static&rate_hz=100&columns=gz=angular_rate:z:deg/s")
        self.assertEqual((stated["problems"], stated["rate_hz"]), ([], {"value": 100, "from": "stated"}))
        self.assertEqual(stated["columns"][0]["from"], "stated")

    def test_a_rising_column_is_proposed_as_the_time_with_its_unit(self) -> None:
        lines = [f"{i * 4},{math.sin(i):.3f}" for i in range(300)]
        found = self.preview(("all_time,gz [deg/s]\n" + "\n".join(lines) + "\n").encode())
        self.assertEqual(found["time_guess"], {"column": "all_time", "unit": "ms", "rate_hz": 250})
        unnamed = self.preview(("k,gz [deg/s]\n" + "\n".join(lines) + "\n").encode())
        self.assertEqual(unnamed["time_guess"]["column"], "k")
        counted = self.preview(("row,gz [deg/s]\n" + "\n".join(f"{i},{math.sin(i):.3f}" for i in range(300)) + "\n").encode())
        self.assertIsNone(counted["time_guess"], "a number of the row is no time")

    def test_the_beginning_of_a_longer_file_is_enough(self) -> None:
        text = self.turning(5000)
        found = self.preview(text[:10001], of=len(text))
        self.assertEqual((found["whole_file"], found["problems"], found["notes"]), (False, [], []))
        self.assertEqual(found["rows_seen"], text[:10001].count(b"\n") - 1)
        packed = gzip.compress(text)
        found = self.preview(packed[:len(packed) // 2], of=len(packed))
        self.assertEqual((found["format"], found["compression"], found["problems"]), ("csv", "gzip", []))
        self.assertGreater(found["rows_seen"], 500)
        array = samples.npy([[1.0] * 4000] * 3)
        found = self.preview(array[:20000], of=len(array))
        self.assertEqual([c["from"] for c in found["columns"]], ["number"] * 3)
        self.assertGreater(found["rows_seen"], 800)

    def test_a_unit_that_cannot_be_is_hinted_at(self) -> None:
        noise = samples.noise(600, seed=12)[0]
        lines = [f"{i * 0.01:.2f},0.01,0.02,{9.81 + 0.01 * value:.4f}" for i, value in enumerate(noise)]
        found = self.preview(("time [s],ax [g],ay [g],az [g]\n" + "\n".join(lines) + "\n").encode(), "?condition=static")
        self.assertTrue(any("gravity" in hint for hint in found["hints"]), found)

    def test_what_is_no_recording_says_so_and_too_much_is_refused(self) -> None:
        found = self.preview(b"PK\x03\x04" + bytes(200), of=204)
        self.assertEqual((found["format"], found["columns"]), (None, []))
        self.assertTrue(found["problems"][0]["detail"])
        headers = {"Content-Type": "application/octet-stream"}
        self.problem(413, "limit_exceeded", self.daemon.request("POST", "/v1/recordings/preview", bytes((1 << 20) + 1), headers))
        for name, query, extra in (("rate_hz", "?rate_hz=fast", {}), ("condition", "?condition=dancing", {}), ("columns", "?columns=gz=colour", {}),
                                   ("Content-Range", "", {"Content-Range": "bytes 5-9/10"})):
            answer = self.daemon.request("POST", "/v1/recordings/preview" + query, b"gz\n1\n", {**headers, **extra})
            self.assertIn(answer.status, (400, 422), name)
            self.assertEqual(answer.json["where"]["parameter"], name)


if __name__ == "__main__":
    unittest.main()
