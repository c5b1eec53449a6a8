"""The same drive in several formats gives the same outages; what the sources of a drive may do wrong, by its sentence."""
from __future__ import annotations

import copy
import csv
import datetime
import io
import json
import math
import struct
import subprocess
import unittest
import zipfile
from pathlib import Path
from typing import Any, Callable

import drive_documents
import samples
from drives_test import Folder, PROGRAM, SHARED

NAV = SHARED.parent / "nav"
GPS_EPOCH = 315964800.0


def rows_of(table: bytes) -> list[list[float]]:
    return [[float(cell) for cell in row] for row in list(csv.reader(io.StringIO(table.decode())))[1:]]


def text_of(rows: list[list[float]], separator: str = " ") -> str:
    return "".join(separator.join(repr(value) for value in row) + "\n" for row in rows)


def mat_struct(name: str, fields: dict[str, list[list[float]]]) -> bytes:
    """A MATLAB 5 file with one struct of real matrices, given by column."""
    def element(kind: int, data: bytes) -> bytes:
        return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)

    def matrix(label: str, cls: int, rows: int, columns: int, content: bytes) -> bytes:
        return element(14, element(6, struct.pack("<II", cls, 0)) + element(5, struct.pack("<ii", rows, columns))
                       + element(1, label.encode()) + content)
    numbers = b"".join(matrix("", 6, len(columns[0]), len(columns), element(9, b"".join(struct.pack(f"<{len(c)}d", *c) for c in columns)))
                       for columns in fields.values())
    names = element(1, b"".join(field.encode().ljust(32, b"\0") for field in fields))
    content = struct.pack("<HHI", 5, 4, 32) + names + numbers
    return b"MATLAB 5.0 MAT-file, made up".ljust(124) + b"\x00\x01IM" + matrix(name, 2, 1, 1, content)


def columns_as(columns: dict[str, Any], renamed: dict[str, str]) -> dict[str, Any]:
    return {renamed[name]: role for name, role in columns.items()}


class MadeUpDrive(Folder):
    """`samples.drive_csvs` at GPS second 345600 of week 2300, in the words of other programs."""
    WEEK, SECOND = 2300, 345600.0

    def setUp(self) -> None:
        super().setUp()
        readings, fixes = samples.drive_csvs(seconds=400)
        # Driven faster, so that stamps are whole multiples of 1/32 s: the same numbers on every clock below.
        self.readings = [[(i + 1) / 32.0, *row[1:]] for i, row in enumerate(rows_of(readings))]
        self.fixes = [[0.625 * row[0], *row[1:4], *(v / 0.625 for v in row[4:])] for row in rows_of(fixes)]
        for row in self.readings:
            row[4] /= 0.625 ** 2

    def document(self, imu: str, gnss: str) -> dict[str, Any]:
        document = samples.drive_document(imu, gnss)
        for source in ("imu", "gnss"):
            document[source]["file"] = document[source].pop("recording")
        document["outages"] = {"duration_s": [10], "at": [80.1, 120.2, 170.3]}  # no fix on an edge
        return document

    def found(self, document: dict[str, Any]) -> list[dict[str, Any]]:
        return list(json.loads(self.drive(0, "run", document, "--json"))["durations"])

    def as_csv(self) -> dict[str, Any]:
        for name, rows, names in (("imu.csv", self.readings, samples.DRIVE_IMU), ("gnss.csv", self.fixes, samples.DRIVE_GNSS)):
            (self.folder / name).write_text(",".join(names) + "\n" + text_of(rows, ","))
        return self.document("imu.csv", "gnss.csv")


class LeftHandedUnit(MadeUpDrive):
    def test_an_axis_that_points_back_is_said_by_its_sign(self) -> None:
        document = copy.deepcopy(self.as_csv())
        wanted = self.found(document)
        mirrored = [[row[0], *row[1:4], -row[4], *row[5:]] for row in self.readings]
        (self.folder / "imu.csv").write_text(",".join(samples.DRIVE_IMU) + "\n" + text_of(mirrored, ","))
        name = list(samples.DRIVE_IMU)[4]
        self.assertEqual((document["imu"]["columns"][name]["quantity"], document["imu"]["columns"][name]["axis"]), ("specific_force", "x"))
        refused = self.drive(2, "run", document)
        self.assertIn("The accelerometer's x points back where the speed rises", refused)
        document["imu"]["columns"][name]["axis"] = "-x"
        self.assertEqual(self.found(document), wanted)
        document["gnss"]["columns"][list(samples.DRIVE_GNSS)[1]]["axis"] = "-lat"
        self.assertIn("gnss_position has one of the axes lat, lon, height", self.drive(2, "run", document))


def single(value: float) -> float:
    """As a log of PX4 keeps it."""
    return float(struct.unpack("<f", struct.pack("<f", value))[0])


def ulog(readings: list[list[float]], fixes: list[list[float]]) -> bytes:
    """A PX4 log of both, in the order of time."""
    def message(letter: bytes, body: bytes) -> bytes:
        return struct.pack("<H", len(body)) + letter + body
    topics = ((0, "sensor_combined", "uint64_t timestamp;float[3] gyro_rad;float[3] accelerometer_m_s2;"),
              (1, "sensor_gps", "uint64_t timestamp;double latitude_deg;double longitude_deg;double altitude_ellipsoid_m;"
                                "float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;"))
    front = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0) + message(b"B", bytes(40))
    front += b"".join(message(b"F", f"{name}:{fields}".encode()) for _, name, fields in topics)
    front += b"".join(message(b"A", struct.pack("<BH", 0, number) + name.encode()) for number, name, _ in topics)
    data = [(row[0], struct.pack("<HQ6f", 0, round(1e6 * row[0]), *row[1:])) for row in readings]
    data += [(row[0], struct.pack("<HQ3d3f", 1, round(1e6 * row[0]), *row[1:])) for row in fixes]
    return front + b"".join(message(b"D", body) for _, body in sorted(data, key=lambda each: each[0]))


def bag(readings: list[list[float]], fixes: list[list[float]]) -> bytes:
    """A ROS 1 bag of sensor_msgs/Imu and sensor_msgs/NavSatFix, in the order of time."""
    def record(fields: list[bytes], data: bytes) -> bytes:
        header = b"".join(struct.pack("<I", len(field)) + field for field in fields)
        return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data

    def header(seconds: float) -> bytes:
        nanoseconds = round(1e9 * seconds)
        return struct.pack("<IIII", 0, 1_700_000_000 + nanoseconds // 10**9, nanoseconds % 10**9, 0)
    nothing = bytes(9 * 8)
    messages = [(row[0], 0, header(row[0]) + bytes(4 * 8) + nothing + struct.pack("<3d", *row[1:4]) + nothing
                 + struct.pack("<3d", *row[4:7]) + nothing) for row in readings]
    messages += [(row[0], 1, header(row[0]) + struct.pack("<bH3d", 0, 1, *row[1:4]) + nothing + b"\0") for row in fixes]
    topics = [record([b"op=\x07", b"conn=" + struct.pack("<I", number), b"topic=" + name], struct.pack("<I", len(kind)) + kind)
              for number, name, kind in ((0, b"/imu", b"type=sensor_msgs/Imu"), (1, b"/fix", b"type=sensor_msgs/NavSatFix"))]
    said = [record([b"op=\x02", b"conn=" + struct.pack("<I", number), b"time=" + bytes(8)], data)
            for _, number, data in sorted(messages, key=lambda each: each[0])]
    return b"#ROSBAG V2.0\n" + record([b"op=\x03", b"index_pos=" + struct.pack("<Q", 1)], b"") + b"".join(topics + said)


class SameDrive(MadeUpDrive):
    def of_one_log(self, file: str, velocity: bool) -> dict[str, Any]:
        """The document of a log that holds readings and fixes."""
        document = self.document(file, file)
        imu, gnss = document["imu"], document["gnss"]
        imu["columns"] = columns_as(imu["columns"], {**{f"g{a}": f"gyro_{a} (rad/s)" for a in "xyz"},
                                                     **{f"a{a}": f"acc_{a} (m/s^2)" for a in "xyz"}})
        renamed = {"lat": "gnss_latitude (deg)", "lon": "gnss_longitude (deg)", "height": "gnss_height (m)"}
        if velocity:
            renamed |= {f"v{way[0]}": f"gnss_velocity_{way} (m/s)" for way in ("north", "east", "down")}
        gnss["columns"] = {renamed[name]: role for name, role in gnss["columns"].items() if name in renamed}
        imu["time"]["column"], gnss["time"]["column"] = "time (s)", "gnss_time (s)"
        return document

    def test_one_log_of_px4_here_and_on_a_server(self) -> None:
        self.readings = [[row[0], *map(single, row[1:])] for row in self.readings]
        self.fixes = [[*row[:4], *map(single, row[4:])] for row in self.fixes]
        (self.folder / "flight.ulg").write_bytes(ulog(self.readings, self.fixes))
        document = self.of_one_log("flight.ulg", velocity=True)
        found = self.found(document)
        self.assertEqual(found, self.found(self.as_csv()))
        facts = json.loads(self.drive(0, "check", document, "--json"))["facts"]
        self.assertEqual((facts["imu"]["rows"], facts["gnss"]["fixes"]), (len(self.readings), len(self.fixes)))
        stored = self.expect(201, self.daemon.upload((self.folder / "flight.ulg").read_bytes(), device="px4", condition="drive"))
        for source in ("imu", "gnss"):
            del document[source]["file"]
            document[source]["recording"] = stored.json["id"]
        kept = self.expect(201, self.daemon.post("/v1/drives", document)).json["id"]
        asked = self.expect(202, self.daemon.post("/v1/drive-evaluations", {"drive": kept, "question": "run"}))
        self.assertEqual(self.daemon.finished(asked.json["id"])["state"], "succeeded")
        self.assertEqual(self.expect(200, self.daemon.get(asked.headers["location"])).json["evaluation"]["durations"], found)

    def test_a_draft_of_a_log_is_its_document_but_for_what_only_people_know(self) -> None:
        (self.folder / "flight.ulg").write_bytes(ulog(self.readings, self.fixes))
        done = subprocess.run([PROGRAM, "drive", "draft", "flight.ulg"], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("state gnss.lever_arm_m", done.stderr)
        draft = json.loads(done.stdout)
        self.drive(0, "check", draft)
        wanted = self.of_one_log("flight.ulg", velocity=True)
        draft["imu"]["mounting_deg"] = [0, 0, 0]
        draft["gnss"] |= {name: wanted["gnss"][name] for name in ("position_sd_m", "velocity_sd_m_s")}
        draft |= {name: wanted[name] for name in ("model", "outages")}
        self.assertEqual(self.found(draft), self.found(wanted))
        done = subprocess.run([PROGRAM, "drive", "draft", "gnss.csv"], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.as_csv()
        done = subprocess.run([PROGRAM, "drive", "draft", "gnss.csv"], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("No column of gnss.csv is the angular rate along x", done.stderr)

    def test_one_ros_bag(self) -> None:
        (self.folder / "drive.bag").write_bytes(bag(self.readings, self.fixes))
        apart = self.as_csv()
        apart["gnss"]["columns"] = {name: role for name, role in apart["gnss"]["columns"].items() if not name.startswith("v")}
        together = self.of_one_log("drive.bag", velocity=False)
        apart["start"] = together["start"] = {"heading_deg": 0}
        self.assertEqual(self.found(together), self.found(apart))

    def test_an_export_of_a_phone(self) -> None:
        """Sensor Logger's ZIP: the axes by name, and fixes with speed and bearing in a file of their own."""
        def clock(seconds: float) -> str:
            return f"{1_700_000_000_000_000_000 + round(1e9 * seconds)},{seconds!r}"
        with zipfile.ZipFile(self.folder / "walk.zip", "w") as archive:
            for name, first in (("Gyroscope", 1), ("AccelerometerUncalibrated", 4)):
                rows = "".join(f"{clock(row[0])},{row[first + 2]!r},{row[first + 1]!r},{row[first]!r}\n" for row in self.readings)
                archive.writestr(f"{name}.csv", "time,seconds_elapsed,z,y,x\n" + rows)
            moving = [(*row[:4], math.hypot(row[4], row[5]), math.degrees(math.atan2(row[5], row[4])) % 360.0) for row in self.fixes]
            rows = "".join(f"{clock(t)},{speed!r},{course!r},{height!r},{lon!r},{lat!r}\n" for t, lat, lon, height, speed, course in moving)
            archive.writestr("Location.csv", "time,seconds_elapsed,speed,bearing,altitude,longitude,latitude\n" + rows)
        apart = self.as_csv()
        columns = {name: role for name, role in apart["gnss"]["columns"].items() if not name.startswith("v")}
        apart["gnss"]["columns"] = columns | {"speed": drive_documents.role("gnss_speed", "", "m/s"),
                                              "course": drive_documents.role("gnss_course", "", "deg")}
        (self.folder / "gnss.csv").write_text("t,lat,lon,height,speed,course\n" + text_of([list(row) for row in moving], ","))
        together = copy.deepcopy(apart)
        together["imu"]["columns"] = columns_as(apart["imu"]["columns"], {**{f"g{a}": f"Gyroscope {a} (rad/s)" for a in "xyz"},
                                                                         **{f"a{a}": f"Accelerometer {a} (m/s^2)" for a in "xyz"}})
        together["gnss"]["columns"] = columns_as(apart["gnss"]["columns"],
                                                 {"lat": "gnss_latitude (deg)", "lon": "gnss_longitude (deg)", "height": "gnss_height (m)",
                                                  "speed": "gnss_speed (m/s)", "course": "gnss_course (deg)"})
        for source, time in (("imu", "time (s)"), ("gnss", "gnss_time (s)")):
            together[source]["file"], together[source]["time"]["column"] = "walk.zip", time
        self.assertEqual(self.found(together), self.found(apart))
        done = subprocess.run([PROGRAM, "drive", "draft", "walk.zip"], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        draft = json.loads(done.stdout)
        facts = json.loads(self.drive(0, "check", draft, "--json"))["facts"]
        self.assertEqual((facts["imu"]["rows"], facts["gnss"]["fixes"]), (len(self.readings), len(self.fixes)))

    def test_structs_of_navego(self) -> None:
        t, lat, lon, height, *velocity = [list(column) for column in zip(*self.fixes)]
        (self.folder / "gnss.mat").write_bytes(mat_struct("gnss", {"t": [t], "lat": [lat], "lon": [lon], "h": [height], "vel": velocity,
                                                                   "freq": [[1.6]]}))
        t, *six = [list(column) for column in zip(*self.readings)]
        (self.folder / "imu.mat").write_bytes(mat_struct("imu", {"t": [t], "wb": six[:3], "fb": six[3:], "freq": [[32.0]]}))
        document = self.document("imu.mat", "gnss.mat")
        imu, gnss = document["imu"], document["gnss"]
        imu["columns"] = columns_as(imu["columns"], {**{f"g{a}": f"imu.wb_{a}" for a in "xyz"}, **{f"a{a}": f"imu.fb_{a}" for a in "xyz"}})
        gnss["columns"] = columns_as(gnss["columns"], {"lat": "gnss.lat", "lon": "gnss.lon", "height": "gnss.h",
                                                       "vn": "gnss.vel_x", "ve": "gnss.vel_y", "vd": "gnss.vel_z"})
        imu["time"]["column"], gnss["time"]["column"] = "imu.t", "gnss.t"
        self.assertEqual(self.found(document), self.found(self.as_csv()))

    def test_texts_of_kf_gins(self) -> None:
        increments = [[self.SECOND, *[0.0] * 6]] + [[self.SECOND + row[0], *(value / 32.0 for value in row[1:])] for row in self.readings]
        (self.folder / "imu.txt").write_text(text_of(increments))
        (self.folder / "gnss.txt").write_text(text_of([[self.SECOND + row[0], *row[1:4], 1.0, 1.0, 2.0, *row[4:]] for row in self.fixes]))
        document = self.document("imu.txt", "gnss.txt")
        imu, gnss = document["imu"], document["gnss"]
        imu["columns"] = columns_as(imu["columns"], {**{f"g{a}": f"gyro_{a} (rad/s)" for a in "xyz"},
                                                     **{f"a{a}": f"acc_{a} (m/s^2)" for a in "xyz"}})
        gnss["columns"] = columns_as(gnss["columns"], {"lat": "1", "lon": "2", "height": "3", "vn": "7", "ve": "8", "vd": "9"})
        imu["time"]["column"], gnss["time"]["column"] = "time (s)", "0"
        self.assertEqual(self.found(document), self.found(self.as_csv()))

    def test_a_solution_of_rtklib(self) -> None:
        week = GPS_EPOCH + 604800.0 * self.WEEK + self.SECOND

        def date(seconds: float) -> str:
            moment = datetime.datetime(1970, 1, 1) + datetime.timedelta(seconds=week + seconds)
            return moment.strftime("%Y/%m/%d %H:%M:%S.") + f"{moment.microsecond // 1000:03d}"
        lines = ["%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) vn(m/s) ve(m/s) vu(m/s)"]
        lines += [f"{date(t)} {lat!r} {lon!r} {height!r} 1 9 1.0 {vn!r} {ve!r} {-vd!r}" for t, lat, lon, height, vn, ve, vd in self.fixes]
        (self.folder / "rover.pos").write_text("\n".join(lines) + "\n")
        document = self.as_csv()
        wanted = self.found(document)
        gnss = document["gnss"]
        gnss["columns"] = columns_as(gnss["columns"], {"lat": "latitude(deg)", "lon": "longitude(deg)", "height": "height(m)",
                                                       "vn": "vn(m/s)", "ve": "ve(m/s)", "vd": "vu(m/s)"})
        gnss["columns"]["vu(m/s)"]["axis"] = "up"
        gnss["file"], gnss["time"]["column"] = "rover.pos", "time (s)"
        document["imu"]["time"]["offset_s"] = week
        found = self.found(document)
        for ours, theirs in zip(found, wanted):  # 1.7e9 s have a resolution of 0.24 us: some micrometres at 10 m/s
            self.assertEqual(ours["n"], theirs["n"])
            self.assertAlmostEqual(ours["rms_m"]["value"], theirs["rms_m"]["value"], delta=1e-3 * theirs["rms_m"]["value"])

    def test_fixes_inside_outages_leave_no_trace_in_the_file(self) -> None:
        document = self.as_csv()
        places = {name: {**document["gnss"]["columns"][name], "quantity": "reference_position"} for name in ("lat", "lon", "height")}
        document["reference"] = {"file": "gnss.csv", "time": document["gnss"]["time"], "sd_m": 1.0, "columns": places}
        document["gnss"]["file"] = "fixes.csv"
        header = ",".join(samples.DRIVE_GNSS) + "\n"
        found = []
        for duration in (10, 20):
            document["outages"]["duration_s"] = [duration]
            for left_out in (False, True):
                rows = [row for row in self.fixes
                        if not (left_out and any(at < row[0] < at + duration for at in document["outages"]["at"]))]
                (self.folder / "fixes.csv").write_text(header + text_of(rows, ","))
                found.append(self.found(document))
        self.assertEqual(found[0], found[1])
        self.assertEqual(found[2], found[3])
        self.assertEqual(found[0][0]["n"], 3)


class Spoilt(MadeUpDrive):
    """Section 8 of the specification: refused with a reason, or survived and counted."""

    def given(self, change: Callable[[dict[str, Any], list[list[float]], list[list[float]]], None]) -> dict[str, Any]:
        kept = copy.deepcopy((self.readings, self.fixes))
        document = self.document("imu.csv", "gnss.csv")
        change(document, self.readings, self.fixes)
        self.as_csv()
        self.readings, self.fixes = kept
        return document

    def test_survived_and_counted(self) -> None:
        def checked(change: Callable[[dict[str, Any], list[list[float]], list[list[float]]], None]) -> dict[str, Any]:
            document = self.given(change)
            self.drive(0, "run", document)
            return dict(json.loads(self.drive(0, "check", document, "--json")))

        def placeholders(_: dict[str, Any], __: list[list[float]], fixes: list[list[float]]) -> None:
            for row in fixes[:4]:
                row[1:4] = [45.0, 45.0, 0.0]
            fixes[4][1:4] = [0.0, 0.0, 0.0]
        gnss = checked(placeholders)["facts"]["gnss"]
        self.assertEqual(gnss["far_away"] + gnss["incomplete"], 5)

        def repeated(_: dict[str, Any], readings: list[list[float]], __: list[list[float]]) -> None:
            readings[1000][0] = readings[999][0]
        self.assertGreaterEqual(checked(repeated)["facts"]["imu"]["rows"], 4000)

        def not_a_number(_: dict[str, Any], readings: list[list[float]], fixes: list[list[float]]) -> None:
            readings[2000][3] = math.nan
            fixes[50][1] = math.nan
        self.assertEqual(checked(not_a_number)["facts"]["gnss"]["incomplete"], 1)

        def ends_early(_: dict[str, Any], readings: list[list[float]], __: list[list[float]]) -> None:
            del readings[4800:]
        checked(ends_early)

        def over_the_week(document: dict[str, Any], readings: list[list[float]], fixes: list[list[float]]) -> None:
            for row in readings + fixes:
                row[0] = (row[0] + 604800.0 - 100.0) % 604800.0
        checked(over_the_week)


@unittest.skipUnless(NAV.exists(), f"SKIPPED: NaveGo's rover, for it is not in {NAV} (set DRIFTLAB_SHARED)")
class Shared(Folder):
    def test_navegos_rover_is_read(self) -> None:
        drive_documents.link(self.folder, NAV / "navego_canada")
        found = json.loads(self.drive(0, "run", drive_documents.rover(), "--json"))
        self.assertEqual((found["facts"]["imu"]["rows"], found["facts"]["gnss"]["fixes"]), (73453, 7238))
        self.assertEqual([duration["n"] for duration in found["durations"]], [30, 19])

    def test_the_fixes_of_kf_gins_are_read(self) -> None:
        self.assertTrue(Path(NAV / "kfgins" / "GNSS-RTK.txt").exists())
        document = samples.drive_document("imu", "gnss")
        readings, _ = samples.drive_csvs()
        (self.folder / "imu.csv").write_bytes(readings)
        (self.folder / "gnss.txt").symlink_to(NAV / "kfgins" / "GNSS-RTK.txt")
        for source, file in (("imu", "imu.csv"), ("gnss", "gnss.txt")):
            del document[source]["recording"]
            document[source]["file"] = file
        document["imu"]["time"]["offset_s"] = 456300.0
        document["gnss"]["columns"] = {str(i + 1): drive_documents.role("gnss_position", axis, unit)
                                       for i, (axis, unit) in enumerate((("lat", "deg"), ("lon", "deg"), ("height", "m")))}
        document["gnss"]["time"]["column"] = "0"
        facts = json.loads(self.drive(0, "check", document, "--json"))["facts"]["gnss"]
        self.assertAlmostEqual(facts["rate_hz"], 1.0, places=6)


if __name__ == "__main__":
    unittest.main()
