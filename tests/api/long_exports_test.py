"""The recordings above 1.5 MB through `driftlab export --target kalibr`: a file with a finite noise density, or one sentence why not."""
from __future__ import annotations

import unittest

from real_exports import export_all


class LongExports(unittest.TestCase):
    def test_every_large_recording_gives_a_kalibr_file_or_a_sentence(self) -> None:
        self.assertGreater(export_all(self, lambda size: size > 1_500_000), 8)


if __name__ == "__main__":
    unittest.main()
