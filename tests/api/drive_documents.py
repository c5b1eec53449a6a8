"""Documents of the shared drives, which may not be committed: written here, beside links to the recordings."""
from __future__ import annotations

from pathlib import Path
from typing import Any


def role(quantity: str, axis: str | None = None, unit: str | None = None) -> dict[str, str]:
    return {"quantity": quantity, **({"axis": axis} if axis else {}), **({"unit": unit} if unit else {})}


def model(gyro: float, force: float, gyro_walk: float = 2e-4, force_walk: float = 2e-4, bias_mg: float = 20) -> dict[str, Any]:
    """White noise [deg/s/sqrt(Hz)], [m/s^2/sqrt(Hz)], random walks per sqrt(s) of the same, biases."""
    def process(name: str, parameter: str, value: float, unit: str) -> dict[str, Any]:
        return {"process": name, "params": {parameter: {"value": value, "unit": unit}}}
    return {"gyroscope": {"processes": [process("white_noise", "N", 60 * gyro, "deg/sqrt(h)"),
                                        process("random_walk", "K", 216000 * gyro_walk, "deg/h/sqrt(h)")], "constant_bias_sd_deg_s": 0.5},
            "accelerometer": {"processes": [process("white_noise", "N", 60 * force, "m/s/sqrt(h)"),
                                            process("random_walk", "K", 60 * force_walk / 9.80665e-3, "mg/sqrt(h)")], "constant_bias_sd_mg": bias_mg}}


def car() -> dict[str, Any]:
    """The README's mounting, an arm of 0 +- 1 m, no offsets; what the data sheet says of the unit."""
    force = {str(i): role("specific_force", axis, "g") for i, axis in enumerate("xyz")}
    rate = {str(3 + i): role("angular_rate", axis, "deg/s") for i, axis in enumerate("xyz")}
    fixes = {"latitude(deg)": role("gnss_position", "lat", "deg"), "longitude(deg)": role("gnss_position", "lon", "deg"),
             "height(m)": role("gnss_position", "height", "m"), "vn(m/s)": role("gnss_velocity", "north", "m/s"),
             "ve(m/s)": role("gnss_velocity", "east", "m/s"), "vu(m/s)": role("gnss_velocity", "up", "m/s"),
             "sdn(m)": role("gnss_accuracy", "north", "m"), "sde(m)": role("gnss_accuracy", "east", "m"),
             "sdu(m)": role("gnss_accuracy", "down", "m"), "sdvn": role("gnss_accuracy", "speed", "m/s"), "Q": role("fix_type")}
    return {"id": "rtk-car-0708", "vehicle": "road",
            "imu": {"file": "imu_1934.csv.xz", "columns": {**force, **rate}, "clock": "host", "mounting_deg": [180, -6.79, 185.35],
                    "time": {"column": "6", "unit": "ms", "scale": "boot", "tag": "imu_1934.csv.tag.xz"}},
            "gnss": {"file": "gnss_1934_sf.pos.xz", "columns": fixes, "time": {"column": "time (s)", "unit": "s", "scale": "gps"},
                     "lever_arm_m": [0, 0, 0], "lever_arm_sd_m": 1.0, "fix_types": [1, 2]},
            "reference": "withheld_fixes", "model": model(0.0038, 70e-6 * 9.80665)}


def phone() -> dict[str, Any]:
    def triad(name: str, quantity: str, unit: str) -> dict[str, Any]:
        return {f"{name}{axis.upper()} [{unit}]": role(quantity, axis, unit) for axis in "xyz"}

    def time(name: str) -> dict[str, Any]:
        return {"column": f"Timestamp{name} [ns]", "unit": "ns", "scale": "boot"}
    fixes = {"Lat [deg]": role("gnss_position", "lat", "deg"), "Lon [deg]": role("gnss_position", "lon", "deg"),
             "Height [m]": role("gnss_position", "height", "m"), "Speed [m/s]": role("gnss_speed", None, "m/s"),
             "Heading [deg]": role("gnss_course", None, "deg"), "Hor Acc [m]": role("gnss_accuracy", "horizontal", "m"),
             "Vert Acc [m]": role("gnss_accuracy", "vertical", "m"), "Speed Acc [m/s]": role("gnss_accuracy", "speed", "m/s")}
    name = "20201104_091730_{}.csv.xz"
    return {"id": "phone-motorway-1104", "vehicle": "road",
            "imu": {"file": name.format("Gyro"), "columns": triad("Gyro", "angular_rate", "rad/s"), "time": time("Gyro"), "mounting_deg": "unknown",
                    "accelerometer": {"file": name.format("Acc"), "columns": triad("Acc", "specific_force", "m/s^2"), "time": time("Acc")}},
            "gnss": {"file": name.format("GNSS"), "columns": fixes, "time": {**time("GNSS"), "is": "arrival"}, "height_above": "geoid",
                     "velocity_sd_m_s": [0.5, 0.5, 1]},
            "model": model(0.05, 0.01, 2e-4, 1e-3)}


def aircraft() -> dict[str, Any]:
    def of(names: str, quantity: str, axes: list[str], unit: str) -> dict[str, Any]:
        return {f"flight_data.{name}": role(quantity, axis, unit) for name, axis in zip(names.split(), axes)}
    time = {"column": "flight_data.time", "unit": "s", "scale": "boot"}
    file = "thor_flight75_WaypointTracker_150squareWaypointNew_2012_10_10.mat"
    return {"id": "umn-thor-flight75", "vehicle": "air",
            "imu": {"file": file, "time": time,
                    "columns": {**of("p q r", "angular_rate", list("xyz"), "rad/s"), **of("ax ay az", "specific_force", list("xyz"), "m/s^2")}},
            "gnss": {"file": file, "time": time, "hold": True,
                     "columns": {**of("lat lon", "gnss_position", ["lat", "lon"], "deg"), **of("alt", "gnss_position", ["height"], "m"),
                                 **of("vn ve vd", "gnss_velocity", ["north", "east", "down"], "m/s")}},
            "model": model(0.1, 0.02, 5e-4, 2e-3, 30)}


def rover() -> dict[str, Any]:
    """NaveGo's structs: a planetary rover with fixes of 5 m at 20 Hz, made from the reference, which is a file of its own."""
    def triad(name: str, quantity: str, axes: list[str], unit: str) -> dict[str, Any]:
        return {f"{name}_{suffix}": role(quantity, axis, unit) for suffix, axis in zip("xyz", axes)}

    def place(name: str, kind: str) -> dict[str, Any]:
        return {f"{name}.lat": role(f"{kind}_position", "lat", "rad"), f"{name}.lon": role(f"{kind}_position", "lon", "rad"),
                f"{name}.h": role(f"{kind}_position", "height", "m")}

    def time(name: str) -> dict[str, Any]:
        return {"column": f"{name}.t", "unit": "s", "scale": "boot"}
    imu, gnss, reference = "imu_planetary", "gnss_planetary", "gnss_planetary_r"
    return {"id": "navego-canada", "vehicle": "rover",
            "imu": {"file": f"{imu}.mat", "time": time(imu), "columns": {**triad(f"{imu}.wb", "angular_rate", list("xyz"), "rad/s"),
                                                                         **triad(f"{imu}.fb", "specific_force", list("xyz"), "m/s^2")}},
            "gnss": {"file": f"{gnss}.mat", "time": time(gnss), "position_sd_m": [5, 5, 5], "velocity_sd_m_s": [0.1, 0.1, 0.1],
                     "columns": {**place(gnss, "gnss"), **triad(f"{gnss}.vel", "gnss_velocity", ["north", "east", "down"], "m/s")}},
            "reference": {"file": f"{reference}.mat", "time": time(reference), "columns": place(reference, "reference"), "sd_m": 0.1},
            "start": {"heading_deg": 180}, "model": model(0.01, 0.005),
            "outages": {"duration_s": [10, 30], "every_s": [40, 60], "phases": 4, "settle_s": 60}}


def link(folder: Path, recordings: Path) -> None:
    """The files of a recording under their own names in `folder`."""
    for path in recordings.iterdir():
        if path.is_file() and not (folder / path.name).exists():
            (folder / path.name).symlink_to(path)
