#!/usr/bin/env python3
"""Fails where the licence is missing or not whole, or where NOTICE leaves out a library that is linked."""
from __future__ import annotations

import re
from pathlib import Path

import tree

# find_package / find_library in CMakeLists.txt -> the name under which NOTICE credits it.
CREDITED = {"Eigen3": "Eigen", "nlohmann_json": "JSON for Modern C++", "spdlog": "spdlog", "SQLite3": "SQLite",
            "OpenSSL": "OpenSSL", "ZLIB": "zlib", "LibLZMA": "liblzma", "CLI11": "CLI11", "Boost": "Boost", "zstd": "Zstandard",
            "Ceres": "Ceres", "LibArchive": "libarchive", "tomlplusplus": "toml++"}
NOT_SHIPPED = {"Threads", "Python3", "PkgConfig", "GTest", "benchmark"}


def check(root: Path) -> list[str]:
    faults: list[str] = []
    licence, notice = root / "LICENSE", root / "NOTICE"
    if not licence.is_file():
        faults.append("LICENSE: is missing")
    elif not all(part in licence.read_text() for part in ("Apache License", "Version 2.0, January 2004",
                                                          "Grant of Patent License", "END OF TERMS AND CONDITIONS")):
        faults.append("LICENSE: is not the whole text of the Apache License 2.0")
    if not notice.is_file():
        return [*faults, "NOTICE: is missing"]
    credits = notice.read_text()
    build = (root / "CMakeLists.txt").read_text() if (root / "CMakeLists.txt").is_file() else ""
    for package in re.findall(r"find_package\((\w+)", build) + re.findall(r"find_library\(\w+ (\w+)", build):
        if package in NOT_SHIPPED:
            continue
        if CREDITED.get(package, package) not in credits:
            faults.append(f"NOTICE: says nothing of {package}, which CMakeLists.txt links")
    return faults


if __name__ == "__main__":
    tree.main(check)
