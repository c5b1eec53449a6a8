"""Memory stays flat while a recording streams in: 256 MiB here; tests/bench/upload_memory.py does 2 GiB."""
from __future__ import annotations

import os
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "bench"))
import upload_memory  # noqa: E402 - the benchmark is the measurement


@unittest.skipIf(os.environ.get("DRIFTLAB_SANITIZE"), "sanitizers keep memory of their own")
class Memory(unittest.TestCase):
    def test_upload_of_256_mib(self) -> None:
        figures = upload_memory.measure(256)
        print(f"high-water mark grew by {figures.growth_mib:.1f} MiB for {figures.megabytes:.0f} MB")
        self.assertLess(figures.growth_mib, 150)
        grown = (figures.after_kib["RssAnon"] - figures.before_kib["RssAnon"]) / 1024
        self.assertLess(grown, 64, "what the daemon allocated and kept")


if __name__ == "__main__":
    unittest.main()
